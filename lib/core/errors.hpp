#pragma once

#include <stdexcept>
#include <string>

namespace pliant {

/// Process exit codes, as in docs/results.md. After a signal: 128 plus its number, as in shells.
enum class ExitCode {
  success = 0,
  bad_input = 2,
  physics_failure = 3,
  input_output = 4,
  interrupted = 130,
  terminated = 143
};

/// Error whose message is complete for the user: what, where, the value, the allowed range, the next step.
class Error : public std::runtime_error {
 public:
  Error(ExitCode code, const std::string& message) : std::runtime_error(message), code_(code) {}
  ExitCode code() const { return code_; }

 private:
  ExitCode code_;
};

/// The scene or the command line asks for something that cannot be done (exit code 2).
struct InputError : Error {
  explicit InputError(const std::string& message) : Error(ExitCode::bad_input, message) {}
};

/// The simulated physics broke down: J <= 0, NaN, a time step under its floor (exit code 3).
struct PhysicsError : Error {
  explicit PhysicsError(const std::string& message) : Error(ExitCode::physics_failure, message) {}
};

/// A file or folder cannot be read or written (exit code 4 for outputs).
struct OutputError : Error {
  explicit OutputError(const std::string& message) : Error(ExitCode::input_output, message) {}
};

/// A signal asked the program to stop, and it did so in order (exit codes 130 and 143).
struct Stopped : Error {
  Stopped(int signal, const std::string& message) : Error(static_cast<ExitCode>(128 + signal), message) {}
};

}  // namespace pliant
