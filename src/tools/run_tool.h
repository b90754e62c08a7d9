#pragma once

#include <exception>
#include <iostream>

#include <CLI/CLI.hpp>

namespace scan_image_slam {

/// Exit codes that all programs share.
constexpr int kSuccess = 0;
constexpr int kWrongUsage = 1;     ///< options or configuration
constexpr int kUnusableInput = 2;  ///< or results that can't be written

/// main() of a program: parses the options, then calls `configure`, whose errors are those of
/// usage, and `work`, whose errors are those of the input. Tells an error with the program's name.
template <typename Configure, typename Work>
int RunTool(CLI::App* app, int argc, char** argv, const char* name, const Configure& configure,
            const Work& work) {
  int code = kWrongUsage;
  try {
    app->parse(argc, argv);
    configure();
    code = kUnusableInput;
    work();
  } catch (const CLI::ParseError& error) {
    return app->exit(error) == 0 ? kSuccess : kWrongUsage;
  } catch (const std::exception& error) {
    std::cerr << name << ": " << error.what() << "\n";
    return code;
  }
  return kSuccess;
}

}  // namespace scan_image_slam
