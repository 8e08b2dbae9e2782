// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <exception>
#include <iostream>
#include <memory>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "tools/cli/reference/help_format.hpp"
#include "tools/cli/shared/commands.hpp"
#include "tools/files/text/error.hpp"
#include "tools/files/text/suggestion.hpp"

namespace hotfire {

namespace {

disperse::CommandOutcome captured(const std::vector<std::string>& words);

int complain(const std::string& problem, ExitStatus status) {
  std::cerr << "hotfire: " << problem << '\n';
  return static_cast<int>(status);
}

/// What the program takes at this place: the names of its commands or the options of the chosen one.
std::vector<std::string> known_words(const CLI::App& command) {
  std::vector<std::string> words;
  for (const CLI::App* child : command.get_subcommands(is_listed)) {
    words.push_back(child->get_name());
  }
  for (const CLI::Option* option : command.get_options()) {
    words.push_back(option->get_name());
  }
  return words;
}

const CLI::App& chosen_command(const CLI::App& program) {
  const std::vector<CLI::App*> chosen = program.get_subcommands();
  return chosen.empty() ? program : *chosen.front();
}

int complain_of_use(const CLI::App& program, const std::string& problem) {
  const CLI::App& command = chosen_command(program);
  const std::string name = &command == &program ? "hotfire" : "hotfire " + command.get_name();
  return complain(problem + "; see '" + name + " --help'", ExitStatus::wrong_use);
}

/// What `explain` requires: a command without any of it comes from a user without a project.
constexpr std::size_t kWordsOfExplain = 3;

/// The words that a command requires and was not given, all of them: the parser complains of the first.
std::vector<std::string> missing_words(const CLI::App& command) {
  std::vector<std::string> words;
  for (const CLI::Option* option : command.get_options()) {
    if (option->get_required() && option->count() == 0) {
      words.push_back(option->get_name(option->get_positional()));
    }
  }
  return words;
}

/// What the parser has against the words of the command line.
std::string problem_of(const CLI::App& program, const CLI::ParseError& error) {
  const CLI::App& command = chosen_command(program);
  const std::vector<std::string> strangers = program.remaining(true);
  if (strangers.empty() || command.get_allow_extras()) {
    const bool is_missing = dynamic_cast<const CLI::RequiredError*>(&error) != nullptr;
    if (is_missing && &command == &program) {
      return "missing: a command; 'hotfire new rig' makes a project to begin with";
    }
    const std::vector<std::string> missing = is_missing ? missing_words(command) : std::vector<std::string>{};
    const bool has_project = command.get_name() != "explain" || missing.size() < kWordsOfExplain;
    return missing.empty() ? error.what()
                           : fmt::format("missing: {}{}", fmt::join(missing, ", "),
                                         has_project ? "" : "; 'hotfire new rig' makes a project that has them");
  }
  // A misspelt word also leaves out something that is required, which is what the parser complains of.
  const std::vector<std::string> known = known_words(command);
  return "unknown argument \"" + strangers.front() + "\"; " + suggestion(strangers.front(), {known.begin(), known.end()});
}

/// The words of the command line as a shell would take them again.
std::string typed_line(const std::vector<std::string>& words) {
  constexpr std::string_view kPlain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_@%+=:,./-";
  std::string line = "hotfire";
  for (const std::string& word : words) {
    if (!word.empty() && word.find_first_not_of(kPlain) == std::string::npos) {
      line += " " + word;
      continue;
    }
    line += " '";
    for (const char c : word) {
      line += c == '\'' ? std::string("'\\''") : std::string(1, c);
    }
    line += "'";
  }
  return line;
}

int run(std::vector<std::string> words) {
  CLI::App program{
      "Hotfire identifies the effects that a declared model is missing, from test records, and runs the explained model.",
      "hotfire"};
  program.formatter(std::make_shared<HelpFormat>());
  program.set_version_flag("--version", HOTFIRE_VERSION);
  program.require_subcommand(1);
  program.footer(
      "Example: hotfire check declared.toml steps.csv\nExit status: 0 good, 1 the verdict is bad, 2 wrong use, 3 hardware, "
      "4 real-time contract not met, 5 interlock, 6 bad data.");
  add_new(program);
  add_explain(program, typed_line(words));
  add_keys(program);
  add_check(program);
  add_convert(program);
  add_import(program);
  add_simulate(program);
  add_disperse(program, captured);
  add_export(program);
  add_sweep(program);
  add_step(program);
  add_stiffness(program);
  add_hammer(program);
  add_quiescent(program);
  add_response(program);
  add_strings(program);
  add_findings(program);
  add_nastran(program);
  add_linearise(program);
  add_loop(program);
  add_reduce(program);
  add_header(program);
  add_plant(program);
  add_controller(program);
  add_lab(program);
  add_timing(program);
  add_watch(program);
  add_replay(program);
  add_doctor(program);
  add_reference(program);
  for (CLI::App* command : program.get_subcommands(nullptr)) {
    command->set_version_flag("--version", HOTFIRE_VERSION);
  }
  try {
    // The parser takes them from the back.
    std::reverse(words.begin(), words.end());
    program.parse(words);
  } catch (const CLI::RuntimeError& error) {
    return error.get_exit_code();
  } catch (const CLI::Success& help_or_version) {
    return program.exit(help_or_version);
  } catch (const CLI::ParseError& error) {
    return complain_of_use(program, problem_of(program, error));
  } catch (const UsageError& error) {
    return complain_of_use(program, error.what());
  }
  return static_cast<int>(ExitStatus::good);
}

/// Runs a command line, whatever happens, and gives its exit status.
int status_of(const std::vector<std::string>& words) {
  try {
    return run(words);
  } catch (const FileError& error) {
    return complain(error.what(), ExitStatus::bad_data);
  } catch (const std::exception& error) {
    return complain(std::string{"internal error: "} + error.what(), ExitStatus::bad_verdict);
  }
}

/// What a stream is given while this exists.
class Captured {
 public:
  explicit Captured(std::ostream& stream) : stream_(stream), before_(stream.rdbuf(text_.rdbuf())) {}
  ~Captured() { stream_.rdbuf(before_); }
  Captured(const Captured&) = delete;
  Captured& operator=(const Captured&) = delete;
  std::string text() const { return text_.str(); }

 private:
  std::ostringstream text_;
  std::ostream& stream_;
  std::streambuf* before_;
};

disperse::CommandOutcome captured(const std::vector<std::string>& words) {
  const Captured printed(std::cout);
  const Captured complained(std::cerr);
  const int status = status_of(words);
  return {status, printed.text(), complained.text()};
}

}  // namespace

}  // namespace hotfire

int main(int argc, char** argv) { return hotfire::status_of({argv + std::min(argc, 1), argv + argc}); }
