// A program's command line: options, arguments and sub-commands, parsed by CLI11. Its header adds ten seconds to every
// file that includes it, so command_line.cpp alone does.
#pragma once

#include <memory>
#include <optional>
#include <string>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace copse::cli {

/// An option or an argument of a command. Calls can be chained.
class Option {
 public:
  explicit Option(CLI::Option* option) : option_(option) {}

  Option required() const;
  /// --help shows the value that the variable had when the option was declared.
  Option showDefault() const;
  Option typeName(const std::string& name) const;
  Option notEmpty() const;
  Option range(int min, int max) const;
  /// Accepts 2_880_000 for 2880000, as scene files do.
  Option allowUnderscores() const;
  /// For a list: one value per occurrence of the option.
  Option oneValueEach() const;
  /// For a list: "a,b" is two values.
  Option delimiter(char between) const;

  /// Whether it was given; after parsing.
  bool given() const;

 private:
  CLI::Option* option_;
};

/// The options of a program or a sub-command. The variables that they are stored in must outlive parsing.
class CommandLine {
 public:
  explicit CommandLine(CLI::App* app) : app_(app) {}

  /// `names`: "-o,--output", or "FILE" for a positional argument. T: std::string, int, uint32_t, long long, float,
  /// double, std::optional of int or double, or std::vector<std::string>.
  template <class T>
  Option option(const std::string& names, T& value, const std::string& help = "");
  void flag(const std::string& names, bool& value, const std::string& help = "");

  CommandLine addCommand(const std::string& name, const std::string& help);
  /// Whether this sub-command was given; after parsing.
  bool asksFor(const std::string& name) const;

 protected:
  CLI::App* app_;
};

/// The command line of a whole program.
class Program : public CommandLine {
 public:
  /// `name` is the one in messages.
  Program(const std::string& meaning, const std::string& name);
  ~Program();
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  void setVersion(const std::string& text);
  /// One of the sub-commands must be given.
  void requireCommand();
  std::string help() const;

  /// Empty where the program goes on, otherwise its exit status: 0 after --help or --version, 2 after a wrong command
  /// line, with "error: …" and where to find help on standard error.
  std::optional<int> parse(int argc, char** argv);

 private:
  std::unique_ptr<CLI::App> owned_;
};

}  // namespace copse::cli
