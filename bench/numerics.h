#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <cstdio>
#include <ctime>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "geometry/robust.h"

/// What the parts of numerics_bench share.
namespace lumibox::geometry {

/// Results go here, so that no work is optimised away.
inline volatile double sink = 0.0;  // NOLINT: a benchmark's

inline double cpu_ns() {
  std::timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return 1e9 * static_cast<double>(now.tv_sec) + static_cast<double>(now.tv_nsec);
}

inline double ns_per_call(const std::function<double()>& all, std::size_t calls) {
  const double before = cpu_ns();
  sink = sink + all();
  return (cpu_ns() - before) / static_cast<double>(calls);
}

/// `f` summed over the inputs.
template <typename Input, typename F>
std::function<double()> over(const std::vector<Input>& inputs, const F& f) {
  return [&inputs, f] {
    double sum = 0.0;
    for (const Input& input : inputs) sum += f(input);
    return sum;
  };
}

/// Prints a JSON line: the time of one call of either and their ratio, and all of `more`. Both take
/// turns, so that whatever else the machine does meets both.
inline void compare(const std::string& what, const std::string& plain_is, std::size_t calls,
                    const std::function<double()>& robust, const std::function<double()>& plain,
                    const nlohmann::json& more = nlohmann::json::object()) {
  std::vector<double> robust_ns;
  std::vector<double> plain_ns;
  for (int round = 0; round < 21; ++round) {
    robust_ns.push_back(ns_per_call(robust, calls));
    plain_ns.push_back(ns_per_call(plain, calls));
  }
  const double a = median(robust_ns);
  const double b = median(plain_ns);
  nlohmann::json line = {
      {"what", what}, {"plain", plain_is}, {"ns", a}, {"ns_plain", b}, {"ratio", a / b}};
  line.update(more);
  std::puts(line.dump().c_str());
}

/// Reproducible coordinates in [-1, 1).
class Numbers {
 public:
  double next() {
    state_ = state_ * 6364136223846793005U + 1442695040888963407U;
    return static_cast<double>(state_ >> 11U) * 0x1p-52 - 1.0;
  }
  Eigen::Vector3d vector() {
    const double x = next();
    const double y = next();
    return {x, y, next()};
  }

 private:
  std::uint64_t state_ = 1;
};

/// What float would save over double where a frame's pose is found, and what it would cost.
void compare_precision(Numbers* numbers);

}  // namespace lumibox::geometry
