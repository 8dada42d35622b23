#pragma once

#include <exception>
#include <functional>
#include <string>

namespace lumibox::app {

/// Steps of which each is done even if one before it failed, so that an error costs nothing of what
/// the others keep.
class Attempts {
 public:
  /// Does a step. What goes wrong is kept.
  void attempt(const std::function<void()>& step);

  /// Throws what went wrong, if anything did: all in one line, as an error of the first one's kind.
  void rethrow() const;

 private:
  std::exception_ptr first_;
  std::string all_;  ///< what each says
};

}  // namespace lumibox::app
