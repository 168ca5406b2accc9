// The one file that compiles CLI11.
#include "tracer/cli/command_line.h"

#include <CLI/CLI.hpp>
#include <cstdint>
#include <cstdio>
#include <vector>

namespace copse::cli {

Option Option::required() const { return Option(option_->required()); }
Option Option::showDefault() const { return Option(option_->capture_default_str()); }
Option Option::typeName(const std::string& name) const { return Option(option_->type_name(name)); }
Option Option::range(int min, int max) const { return Option(option_->check(CLI::Range(min, max))); }
Option Option::oneValueEach() const { return Option(option_->allow_extra_args(false)); }
Option Option::delimiter(char between) const { return Option(option_->delimiter(between)); }
bool Option::given() const { return option_->count() > 0; }

Option Option::notEmpty() const {
  return Option(
      option_->check([](const std::string& value) { return std::string(value.empty() ? "an empty name" : ""); }));
}

Option Option::allowUnderscores() const {
  return Option(option_->transform([](std::string text) {
    const auto digit = [&](std::size_t i) { return i < text.size() && text[i] >= '0' && text[i] <= '9'; };
    for (std::size_t i = 1; i < text.size(); ++i)
      if (text[i] == '_' && digit(i - 1) && digit(i + 1)) text.erase(i, 1);
    // CLI11 refuses what is still not a number, but since 2.4 accepts underscores anywhere.
    if (text.find('_') != std::string::npos) throw CLI::ValidationError("not a number: " + text);
    return text;
  }));
}

template <class T>
Option CommandLine::option(const std::string& names, T& value, const std::string& help) {
  return Option(app_->add_option(names, value, help));
}
template Option CommandLine::option(const std::string&, std::string&, const std::string&);
template Option CommandLine::option(const std::string&, int&, const std::string&);
template Option CommandLine::option(const std::string&, uint32_t&, const std::string&);
template Option CommandLine::option(const std::string&, long long&, const std::string&);
template Option CommandLine::option(const std::string&, float&, const std::string&);
template Option CommandLine::option(const std::string&, double&, const std::string&);
template Option CommandLine::option(const std::string&, std::optional<int>&, const std::string&);
template Option CommandLine::option(const std::string&, std::optional<double>&, const std::string&);
template Option CommandLine::option(const std::string&, std::vector<std::string>&, const std::string&);

void CommandLine::flag(const std::string& names, bool& value, const std::string& help) {
  app_->add_flag(names, value, help);
}

CommandLine CommandLine::addCommand(const std::string& name, const std::string& help) {
  return CommandLine(app_->add_subcommand(name, help));
}

bool CommandLine::asksFor(const std::string& name) const { return app_->got_subcommand(name); }

Program::Program(const std::string& meaning, const std::string& name)
    : CommandLine(nullptr), owned_(std::make_unique<CLI::App>(meaning, name)) {
  app_ = owned_.get();
  app_->get_formatter()->column_width(34);
}

Program::~Program() = default;

void Program::setVersion(const std::string& text) { app_->set_version_flag("--version", text); }
void Program::requireCommand() { app_->require_subcommand(1); }
std::string Program::help() const { return app_->help(); }

std::optional<int> Program::parse(int argc, char** argv) {
  try {
    app_->parse(argc, argv);
    return {};
  } catch (const CLI::Success& success) {  // --help, --version
    return app_->exit(success);
  } catch (const CLI::ParseError& error) {
    std::string command = app_->get_name();
    for (const CLI::App* asked : app_->get_subcommands()) command += " " + asked->get_name();
    std::fflush(stdout);
    std::fprintf(stderr, "error: %s\nsee: %s --help\n", error.what(), command.c_str());
    return 2;
  }
}

}  // namespace copse::cli
