// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/reference/man_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <sstream>

#include "tools/cli/reference/help_format.hpp"
#include "tools/cli/shared/commands.hpp"

namespace hotfire {

namespace {

constexpr const char* kExample = "Example: ";
constexpr const char* kExitStatus = "Exit status: ";

/// Text as troff prints it letter by letter: hyphens that can be copied, no line that is a request.
std::string plain(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == '\\') {
      result += "\\e";
    } else if (c == '-') {
      result += "\\-";
    } else if ((c == '.' || c == '\'') && (result.empty() || result.back() == '\n')) {
      result += fmt::format("\\&{}", c);
    } else {
      result += c;
    }
  }
  return result;
}

std::string title(const std::string& page) {
  std::string capitals = page;
  std::transform(capitals.begin(), capitals.end(), capitals.begin(), [](unsigned char c) { return std::toupper(c); });
  return fmt::format(".TH {} 1 \"\" \"hotfire {}\" \"Hotfire\"\n", plain(capitals), HOTFIRE_VERSION);
}

std::string name_section(const std::string& page, const std::string& description) {
  return fmt::format(".SH NAME\n{} \\- {}\n", plain(page), plain(description));
}

/// A word, what it takes, and its meaning below.
std::string entry(const std::string& name, const std::string& takes, const std::string& meaning) {
  return fmt::format(".TP\n\\fB{}\\fR{}\n{}\n", plain(name), plain(takes),
                     plain(meaning.empty() ? "(no description)" : meaning));
}

std::string verbatim(const std::string& line) { return fmt::format(".PP\n.nf\n{}\n.fi\n", plain(line)); }

std::string see_also(const std::vector<std::string>& pages) {
  std::string text = ".SH SEE ALSO\n";
  for (const std::string& page : pages) {
    text += fmt::format(".BR {} (1),\n", plain(page));
  }
  return text +
         "the pages below \\fI/usr/share/doc/hotfire/docs\\fR of the package hotfire\\-doc, which this page "
         "calls\n\\fIdocs/\\fR\n";
}

/// What a command says behind its options: examples as they are typed, sentences as paragraphs, exit statuses in a section.
std::string footer_sections(const std::string& footer) {
  std::string examples;
  std::string exit_status;
  bool in_example = false;
  std::istringstream lines(footer);
  for (std::string line; std::getline(lines, line);) {
    const bool continued = line.starts_with(' ');
    line.erase(0, std::min(line.find_first_not_of(' '), line.size()));
    if (line.starts_with(kExitStatus)) {
      exit_status = ".SH EXIT STATUS\n" + plain(line.substr(std::string_view(kExitStatus).size())) + "\n";
      continue;
    }
    in_example = line.starts_with(kExample) || (continued && in_example);
    if (line.starts_with(kExample)) {
      line.erase(0, std::string_view(kExample).size());
    }
    if (in_example) {
      examples += verbatim(line);
    } else {
      examples += (continued ? "" : ".PP\n") + plain(line) + "\n";
    }
  }
  return (examples.empty() ? "" : ".SH EXAMPLES\n" + examples) + exit_status;
}

std::string option_sections(const CLI::App& command) {
  const HelpFormat format;
  std::string positionals;
  std::string options;
  for (const CLI::Option* option : command.get_options()) {
    const bool positional = option->get_positional();
    std::string& section = positional ? positionals : options;
    section +=
        entry(format.make_option_name(option, positional), format.make_option_opts(option), format.make_option_desc(option));
  }
  return (positionals.empty() ? "" : ".SH ARGUMENTS\n" + positionals) + (options.empty() ? "" : ".SH OPTIONS\n" + options);
}

std::string realtime_entries(const RealtimeHelp& realtime) {
  std::string text = ".SH OPTIONS\n";
  for (const RealtimeOption& option : realtime.options) {
    text += entry(option.name, option.value.empty() ? "" : " " + option.value, option.meaning);
  }
  return text;
}

std::string realtime_examples(const RealtimeHelp& realtime) {
  std::string text = ".SH EXAMPLES\n";
  for (const std::string& example : realtime.examples) {
    text += verbatim(example);
  }
  return text;
}

std::string exit_section(const RealtimeHelp& realtime) {
  const std::size_t at = realtime.ending.find(kExitStatus);
  return ".SH EXIT STATUS\n" + plain(realtime.ending.substr(at + std::string_view(kExitStatus).size())) + "\n" +
         plain(realtime.ending.substr(0, at)) + "\n";
}

}  // namespace

std::string program_page(const CLI::App& program) {
  std::string commands = ".SH COMMANDS\n";
  std::vector<std::string> pages;
  for (const CLI::App* command : program.get_subcommands(is_listed)) {
    commands += entry(command->get_name(), "", command->get_description());
    pages.push_back("hotfire-" + command->get_name());
  }
  pages.emplace_back("hotfire-rt");
  return title("hotfire") +
         name_section("hotfire", "find what a model of an actuator is missing, and run the model in real time") +
         ".SH SYNOPSIS\n\\fBhotfire\\fR COMMAND [OPTIONS]\n.SH DESCRIPTION\n" + plain(program.get_description()) + "\n" +
         commands + option_sections(program) + footer_sections(program.get_footer()) + see_also(pages);
}

std::string command_page(const CLI::App& command) {
  const std::string page = "hotfire-" + command.get_name();
  std::string positionals;
  for (const CLI::Option* option : command.get_options([](const CLI::Option* one) { return one->get_positional(); })) {
    positionals += " " + option->get_name(true) + (option->get_items_expected_max() > 1 ? "..." : "");
  }
  return title(page) + name_section(page, command.get_description()) +
         fmt::format(".SH SYNOPSIS\n\\fB{}\\fR [OPTIONS]{}\n", plain("hotfire " + command.get_name()), plain(positionals)) +
         fmt::format(".SH DESCRIPTION\n{}.\n", plain(command.get_description())) + option_sections(command) +
         footer_sections(command.get_footer()) + see_also({"hotfire"});
}

std::string realtime_command_page(const CLI::App& command, const RealtimeHelp& realtime) {
  const std::string page = "hotfire-" + command.get_name();
  return title(page) + name_section(page, command.get_description()) + ".SH SYNOPSIS\n" + plain(realtime.usage) +
         "\n.SH DESCRIPTION\n" + plain(realtime.introduction) + "\n" + realtime_entries(realtime) +
         realtime_examples(realtime) + exit_section(realtime) + see_also({"hotfire", "hotfire-rt"});
}

std::string realtime_page(const RealtimeHelp& realtime) {
  return title("hotfire-rt") + name_section("hotfire-rt", "run a plant, a controller or a lab of Hotfire in real time") +
         ".SH SYNOPSIS\n" + plain(realtime.usage) + "\n.SH DESCRIPTION\n" + plain(realtime.introduction) + "\n" +
         realtime_entries(realtime) + realtime_examples(realtime) + exit_section(realtime) + see_also({"hotfire"});
}

}  // namespace hotfire
