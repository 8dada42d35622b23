#pragma once

#include <filesystem>
#include <fstream>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "app/commands/commands.h"
#include "config/config.h"

/// What `lumibox bench` measures, a file each. All write WHAT.jsonl into options.out.
namespace lumibox::app {

void bench_tracking(const BenchOptions& options, const config::Config& config);
void bench_rendering(const BenchOptions& options, const config::Config& config);
void bench_simulation(const BenchOptions& options);

/// Measurements go to the file one by one, so that a run that is broken off keeps what it has.
class Lines {
 public:
  explicit Lines(const std::filesystem::path& file) : file_(file), stream_(file) {}

  void add(const nlohmann::json& json);

 private:
  std::filesystem::path file_;
  std::ofstream stream_;
};

}  // namespace lumibox::app
