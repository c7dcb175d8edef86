#include "core/stop_signals.hpp"

#include <csignal>

namespace pliant {
namespace {

volatile std::sig_atomic_t noted = 0;

constexpr int signals[] = {SIGINT, SIGTERM};

void note(int signal) {
  noted = signal;
  for (const int other : signals) std::signal(other, SIG_DFL);
}

}  // namespace

StopSignals::StopSignals() {
  noted = 0;
  for (const int signal : signals)
    if (std::signal(signal, note) == SIG_IGN) std::signal(signal, SIG_IGN);
}

StopSignals::~StopSignals() {
  for (const int signal : signals)
    if (std::signal(signal, SIG_DFL) == SIG_IGN) std::signal(signal, SIG_IGN);
}

int StopSignals::received() { return noted; }

const char* signal_name(int signal) { return signal == SIGINT ? "SIGINT" : "SIGTERM"; }

}  // namespace pliant
