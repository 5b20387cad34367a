// The pixels of one kind over a window.
#pragma once

#include <cstddef>
#include <cstring>
#include <memory>
#include <new>
#include <numeric>
#include <type_traits>

#include "base/window.h"

namespace varve {

/// Owning, move-only pixels over `window()`, padded on every side by `border()` pixels so that a pass
/// with that reach needs no edge branches. Rows start on cache lines. What the border holds is the
/// business of the pass that fills it; `Plane(window, border, value)` sets every pixel, border included.
template <class T>
class Plane {
  static_assert(std::is_trivially_copyable_v<T>);

 public:
  Plane() = default;
  explicit Plane(const Window& window, int border = 0) : window_(window), border_(border) {
    const std::size_t columns = std::size_t(window.width()) + 2 * std::size_t(border);
    stride_ = (columns + kStep - 1) / kStep * kStep;
    rows_ = std::size_t(window.height()) + 2 * std::size_t(border);
    if (stride_ * rows_ > 0)
      data_.reset(static_cast<T*>(::operator new(stride_* rows_ * sizeof(T), std::align_val_t(kAlign))));
  }
  Plane(const Window& window, int border, const T& value) : Plane(window, border) { fill(value); }

  bool empty() const { return data_ == nullptr; }
  const Window& window() const { return window_; }
  int border() const { return border_; }
  /// Distance between rows, in elements.
  std::ptrdiff_t stride() const { return std::ptrdiff_t(stride_); }
  std::size_t bytes() const { return stride_ * rows_ * sizeof(T); }

  /// First pixel of row y (display coordinates, border rows allowed): row(y)[x - window().x0] is pixel (x, y).
  T* row(int y) { return data_.get() + offset(y); }
  const T* row(int y) const { return data_.get() + offset(y); }
  T& at(int x, int y) { return row(y)[x - window_.x0]; }
  const T& at(int x, int y) const { return row(y)[x - window_.x0]; }

  void fill(const T& value) {
    for (std::size_t i = 0; i < stride_ * rows_; ++i) data_[i] = value;
  }
  /// A copy; spelled out because it costs a whole plane.
  Plane clone() const {
    Plane copy(window_, border_);
    if (data_) std::memcpy(copy.data_.get(), data_.get(), bytes());
    return copy;
  }

 private:
  static constexpr std::size_t kAlign = 64;
  static constexpr std::size_t kStep = kAlign / std::gcd(kAlign, sizeof(T));  // elements in whole cache lines
  struct Free {
    void operator()(T* p) const { ::operator delete(p, std::align_val_t(kAlign)); }
  };
  std::ptrdiff_t offset(int y) const { return (std::ptrdiff_t(y) - window_.y0 + border_) * stride() + border_; }

  Window window_;
  int border_ = 0;
  std::size_t stride_ = 0, rows_ = 0;
  std::unique_ptr<T[], Free> data_;
};

}  // namespace varve
