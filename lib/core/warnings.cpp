#include "core/warnings.hpp"

#include <algorithm>
#include <memory>
#include <mutex>

#include <spdlog/sinks/base_sink.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

namespace pliant {
namespace {

/// Keeps the texts of warnings.
class KeepingSink : public spdlog::sinks::base_sink<std::mutex> {
 public:
  std::vector<std::string> texts;

 protected:
  void sink_it_(const spdlog::details::log_msg& message) override {
    const std::string text(message.payload.data(), message.payload.size());
    if (message.level == spdlog::level::warn && std::ranges::find(texts, text) == texts.end()) texts.push_back(text);
  }
  void flush_() override {}
};

const std::shared_ptr<KeepingSink>& keeping_sink() {
  static const auto sink = std::make_shared<KeepingSink>();
  return sink;
}

const std::shared_ptr<spdlog::sinks::stderr_sink_st>& stderr_sink() {
  static const auto sink = std::make_shared<spdlog::sinks::stderr_sink_st>();
  return sink;
}

}  // namespace

void install_logger() {
  spdlog::set_default_logger(
      std::make_shared<spdlog::logger>("pliant", spdlog::sinks_init_list{stderr_sink(), keeping_sink()}));
  spdlog::set_pattern("%l: %v");
}

void write_errors_only() { stderr_sink()->set_level(spdlog::level::err); }

const std::vector<std::string>& warnings_so_far() { return keeping_sink()->texts; }

}  // namespace pliant
