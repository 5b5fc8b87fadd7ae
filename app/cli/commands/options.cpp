// SPDX-License-Identifier: MIT
// `scarp options`, hidden: writes the documents that are generated from the declarations of the options.
#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <memory>
#include <string>

#include "app/cli/commands.h"
#include "app/cli/commands/documents.h"
#include "scarp/base/error.h"

namespace scarp::cli {
namespace {

namespace fs = std::filesystem;

void write(const fs::path& path, const std::string& text) {
  fs::create_directories(path.parent_path());
  std::ofstream out(path, std::ios::binary);
  out << text;
  if (!out.flush()) throw Error(fmt::format("'{}': cannot be written", path.string()));
}

// The layout is that of share/ in an installed tree.
void write_share(const Program& program, const fs::path& share) {
  write(share / "bash-completion/completions/scarp", bash_completion(program));
  write(share / "zsh/site-functions/_scarp", zsh_completion(program));
  write(share / "fish/vendor_completions.d/scarp.fish", fish_completion(program));
  write(share / "man/man1/scarp.1", man_page(program));
  for (const Command* command : program.commands())
    write(share / fmt::format("man/man1/scarp-{}.1", command->name()), man_page(*command));
}

}  // namespace

void add_options(Program& program) {
  Command& command = program.add("options", "Write the documents generated from the options", true);
  struct OptionsOptions {
    bool markdown = false, json = false;
    std::string share;
  };
  const auto options = std::make_shared<OptionsOptions>();
  command.add(&options->markdown, {.names = "--markdown", .help = "doc/user/options.md to standard output"});
  command.add(&options->json, {.names = "--json", .help = "every subcommand and option, as JSON, to standard output"});
  command.add(&options->share,
              {.names = "--share", .value = "FOLDER", .help = "completion scripts and man pages below FOLDER"});
  command.runs([options, &program] {
    if (options->markdown) fmt::print("{}", options_markdown(program));
    if (options->json) fmt::print("{}", options_json(program));
    if (!options->share.empty()) write_share(program, options->share);
  });
}

}  // namespace scarp::cli
