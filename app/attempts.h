#pragma once

#include <exception>
#include <functional>

namespace lumibox::app {

/// Steps of which each is done even if one before it failed, so that an error costs nothing of what
/// the others keep.
class Attempts {
 public:
  /// Does a step. The first error is kept; those after it are said.
  void attempt(const std::function<void()>& step);

  /// Throws the first error, if there was one.
  void rethrow_first() const;

 private:
  std::exception_ptr first_;
};

}  // namespace lumibox::app
