#pragma once

namespace pliant {

/// While one lives, SIGINT and SIGTERM are noted instead of ending the program; a second one ends it at once. Signals
/// that the program was started to ignore stay ignored. One at a time.
class StopSignals {
 public:
  StopSignals();
  ~StopSignals();
  StopSignals(const StopSignals&) = delete;
  StopSignals& operator=(const StopSignals&) = delete;

  /// The signal that came, or 0.
  static int received();
};

/// "SIGINT" or "SIGTERM".
const char* signal_name(int signal);

}  // namespace pliant
