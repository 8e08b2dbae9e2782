// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <iostream>
#include <memory>

#include "tools/cli/reference/completion.hpp"
#include "tools/cli/reference/man_page.hpp"
#include "tools/cli/shared/commands.hpp"
#include "tools/files/text/whole_file.hpp"

namespace hotfire {

namespace {

void write_pages(const CLI::App& program, const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  write_whole_file(folder / "hotfire.1", program_page(program));
  write_whole_file(folder / "hotfire-rt.1", realtime_page(realtime_help("")));
  for (const CLI::App* command : program.get_subcommands(is_listed)) {
    const std::string& name = command->get_name();
    write_whole_file(folder / ("hotfire-" + name + ".1"), command->get_allow_extras()
                                                              ? realtime_command_page(*command, realtime_help(name))
                                                              : command_page(*command));
  }
}

}  // namespace

void add_reference(CLI::App& program) {
  const auto folder = std::make_shared<std::string>();
  CLI::App* manual = program.add_subcommand("manual", "Write the man page of every command, for the build");
  manual->group("");
  manual->add_option("FOLDER", *folder, "folder for the pages")->required();
  manual->footer("Example: hotfire manual build/man1");
  manual->callback([&program, folder] { write_pages(program, *folder); });

  const auto words = std::make_shared<std::vector<std::string>>();
  CLI::App* complete = program.add_subcommand("complete", "List what may follow on a command line, for a shell");
  complete->group("");
  complete->add_option("WORDS", *words, "the words behind hotfire, up to the one that is typed, behind --")->required();
  complete->footer("Example: hotfire complete -- explain --mo");
  complete->callback([&program, words] {
    for (const std::string& one : completions(program, *words)) {
      if (one.starts_with('*') || one.starts_with(words->back())) {
        std::cout << one << '\n';
      }
    }
  });
}

}  // namespace hotfire
