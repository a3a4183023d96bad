#include <sixdof/algorithm/ode/ode_lock.h>

#include <cstdarg>
#include <cstdio>
#include <stdexcept>

#include <fmt/format.h>
#include <ode/ode.h>

namespace sixdof {
namespace {

void ignore(int /*number*/, const char* /*format*/, va_list /*arguments*/) {}

/// ODE would end the process after the handler returns.
[[noreturn]] void throw_error(int number, const char* format, va_list arguments) {
  char text[256];
  std::vsnprintf(text, sizeof(text), format, arguments);
  throw std::runtime_error(fmt::format("ODE error {}: {}", number, text));
}

std::mutex& ode_mutex() {
  static std::mutex mutex;
  return mutex;
}

}  // namespace

OdeLock::OdeLock() : lock_(ode_mutex()) {
  static const bool initialised = [] {
    dSetMessageHandler(&ignore);
    dSetErrorHandler(&throw_error);
    dSetDebugHandler(&throw_error);
    return dInitODE2(0) != 0;
  }();
  thread_local const bool has_data = initialised && dAllocateODEDataForThread(dAllocateMaskAll) != 0;
  if (!has_data) throw std::runtime_error("ODE cannot be initialised");
}

}  // namespace sixdof
