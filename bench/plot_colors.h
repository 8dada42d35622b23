#pragma once

#include <string_view>

namespace lumibox::bench::colors {

// Told apart by people of all kinds of sight (Okabe and Ito, 2008).
inline constexpr std::string_view kFinal = "#0072b2";
inline constexpr std::string_view kLive = "#e69f00";
inline constexpr std::string_view kTruth = "#333333";
inline constexpr std::string_view kPerspective = "#009e73";
inline constexpr std::string_view kLost = "#d55e00";
inline constexpr std::string_view kPoor = "#f0e442";
inline constexpr std::string_view kGood = "#a8d5ba";
inline constexpr std::string_view kInitialising = "#c8c8c8";
inline constexpr std::string_view kPoint = "#9a9a9a";

}  // namespace lumibox::bench::colors
