#pragma once

#include <string>

namespace lumibox::config {

/// From now on the calling thread works only when no other wants to. It may be put aside for long,
/// also while it holds a lock: who must not wait only tries. Where that is not allowed a warning
/// says what (`"pictures are judged"`) competes with the loop.
void step_back(const std::string& work);

/// From now on the calling thread has about a tenth of the time of another that wants to work, and
/// all that is left: for what must go on, but not now.
void give_way(const std::string& work);

}  // namespace lumibox::config
