// The only threads in the project.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>

namespace varve {

/// Processors this process may run on, at least 1.
int available_processors();

/// A fixed set of threads that live as long as the object; the calling thread is one of them.
/// Work items must be independent: nothing here depends on which thread runs an item or when,
/// so results are the same for any count. The exception of the lowest item is rethrown.
class Workers {
 public:
  /// count <= 0 takes every processor the process may use.
  explicit Workers(int count = 0);
  ~Workers();
  Workers(const Workers&) = delete;
  Workers& operator=(const Workers&) = delete;

  int count() const;

  /// Calls item(i, worker) for 0 <= i < n; worker < count() names scratch space that no other item uses meanwhile.
  void for_each(std::size_t n, const std::function<void(std::size_t item, int worker)>& item);

  /// Calls row(y) for begin <= y < end, in bands of neighboring rows.
  void for_rows(int begin, int end, const std::function<void(int y)>& row);

  /// Calls work(i, worker) in any order and finish(i) strictly in order, each after its work, never two at once.
  /// At most `ahead` items are worked on before the first unfinished one, which bounds what they may hold.
  void in_order(std::size_t n, std::size_t ahead, const std::function<void(std::size_t item, int worker)>& work,
                const std::function<void(std::size_t item)>& finish);

 private:
  struct Pool;
  std::unique_ptr<Pool> pool_;
};

}  // namespace varve
