#pragma once

namespace pliant {

/// During its lifetime SIGINT and SIGTERM are recorded instead of ending the program; a second one ends it at once.
/// Signals that were ignored at the program's start stay ignored. Only one object at a time.
class StopSignals {
 public:
  StopSignals();
  ~StopSignals();
  StopSignals(const StopSignals&) = delete;
  StopSignals& operator=(const StopSignals&) = delete;

  /// The signal received, or 0.
  static int received();
};

/// "SIGINT" or "SIGTERM".
const char* signal_name(int signal);

}  // namespace pliant
