#include "bench/common/run_guarded.h"

#include <cstdio>
#include <exception>
#include <new>
#include <string>

#include <fmt/format.h>
#include <CLI/Error.hpp>

#include <sixdof/base/error.h>
#include <sixdof/base/visible_text.h>
#include "bench/common/program_end.h"

namespace sixdof {

void print_message(std::string_view program, std::string_view message) {
  // A message may hold words of the command line. Some list what is wrong in lines of their own.
  std::string visible;
  while (true) {
    const std::size_t end = message.find('\n');
    visible += visible_text(message.substr(0, end), k_any_length) + "\n";
    if (end == std::string_view::npos) break;
    message.remove_prefix(end + 1);
  }
  fmt::print(stderr, "{}: {}", program, visible);
}

int run_guarded(std::string_view program, const std::function<void()>& work) {
  const auto report = [&](std::string_view message, int exit_code) {
    print_message(program, message);
    return exit_code;
  };
  try {
    work();
  } catch (const CLI::Error&) {
    throw;
  } catch (const Interrupted& e) {
    return report(e.what(), k_exit_interrupted);
  } catch (const DefectsFound& e) {
    return report(e.what(), k_exit_defects);
  } catch (const std::bad_alloc&) {
    return report("out of memory", k_exit_error);
  } catch (const std::exception& e) {
    const std::string prefix = std::ferror(stdout) != 0 ? "standard output: " : "";
    return report(prefix + e.what(), k_exit_error);
  } catch (...) {
    return report("an exception of unknown type was thrown", k_exit_error);
  }
  return end_output(program);
}

}  // namespace sixdof
