#include <csignal>
#include <cstdio>
#include <exception>

#include "cli/commands.hpp"

int main(int argc, char** argv) {
  using namespace tethercalc;
  // A reader that closes the pipe is an error to report, not a signal to die of.
  std::signal(SIGPIPE, SIG_IGN);
  try {
    return cli::run(argc, argv);
  } catch (const InputError& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return cli::bad_input;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "tethercalc: internal error: %s\n", error.what());
    return cli::internal_error;
  }
}
