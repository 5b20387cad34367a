#include "base/parallel.h"

#include <sched.h>

#include <algorithm>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

namespace varve {

int available_processors() {
  cpu_set_t set;
  CPU_ZERO(&set);
  if (sched_getaffinity(0, sizeof set, &set) == 0) return std::max(1, CPU_COUNT(&set));
  return std::max(1, int(std::thread::hardware_concurrency()));
}

struct Workers::Pool {
  using Item = std::function<void(std::size_t, int)>;

  std::mutex mutex;
  std::condition_variable wake, idle;
  std::vector<std::thread> threads;
  bool stop = false;

  // The job at hand; everything below is guarded by `mutex`.
  const Item* item = nullptr;
  std::size_t next = 0, total = 0, running = 0;
  std::size_t failed_item = 0;
  std::exception_ptr failure;

  // Takes items until none is left. The lock is held on entry and on return.
  void drain(std::unique_lock<std::mutex>& lock, int worker) {
    while (item && next < total) {
      const std::size_t i = next++;
      const Item* call = item;
      ++running;
      lock.unlock();
      std::exception_ptr caught;
      try {
        (*call)(i, worker);
      } catch (...) {
        caught = std::current_exception();
      }
      lock.lock();
      --running;
      if (caught) {
        if (!failure || i < failed_item) failure = caught, failed_item = i;
        next = total;  // items not yet begun are dropped
      }
    }
    if (running == 0) idle.notify_all();
  }
};

Workers::Workers(int count) : pool_(std::make_unique<Pool>()) {
  const int n = count > 0 ? count : available_processors();
  for (int worker = 1; worker < n; ++worker)
    pool_->threads.emplace_back([pool = pool_.get(), worker] {
      std::unique_lock lock(pool->mutex);
      while (!pool->stop) {
        pool->drain(lock, worker);
        pool->wake.wait(lock, [pool] { return pool->stop || (pool->item && pool->next < pool->total); });
      }
    });
}

Workers::~Workers() {
  {
    std::lock_guard lock(pool_->mutex);
    pool_->stop = true;
  }
  pool_->wake.notify_all();
  for (std::thread& thread : pool_->threads) thread.join();
}

int Workers::count() const { return int(pool_->threads.size()) + 1; }

void Workers::for_each(std::size_t n, const std::function<void(std::size_t, int)>& item) {
  std::unique_lock lock(pool_->mutex);
  pool_->item = &item;
  pool_->next = 0;
  pool_->total = n;
  pool_->failure = nullptr;
  pool_->wake.notify_all();
  pool_->drain(lock, 0);
  pool_->idle.wait(lock, [this] { return pool_->running == 0; });
  pool_->item = nullptr;
  if (pool_->failure) std::rethrow_exception(std::exchange(pool_->failure, nullptr));
}

void Workers::for_rows(int begin, int end, const std::function<void(int)>& row) {
  if (begin >= end) return;
  // About eight bands a thread: small enough to balance, large enough that neighbors share cached rows.
  const int band = std::max(1, (end - begin) / (8 * count()));
  const std::size_t bands = std::size_t((end - begin + band - 1) / band);
  for_each(bands, [&](std::size_t i, int) {
    const int first = begin + int(i) * band;
    for (int y = first; y < std::min(end, first + band); ++y) row(y);
  });
}

void Workers::in_order(std::size_t n, std::size_t ahead, const std::function<void(std::size_t, int)>& work,
                       const std::function<void(std::size_t)>& finish) {
  std::mutex mutex;
  std::condition_variable moved;
  std::vector<char> ready(n, 0);
  std::size_t finished = 0;
  bool finishing = false, broken = false;

  for_each(n, [&](std::size_t i, int worker) {
    {
      // Items are handed out in order, so the one everybody waits for is always being worked on.
      std::unique_lock lock(mutex);
      moved.wait(lock, [&] { return broken || i < finished + std::max<std::size_t>(ahead, 1); });
      if (broken) return;
    }
    try {
      work(i, worker);
      std::unique_lock lock(mutex);
      ready[i] = 1;
      // Whoever completes the next item in line finishes it and all that wait behind it.
      if (finishing) return;
      finishing = true;
      while (finished < n && ready[finished] && !broken) {
        lock.unlock();
        finish(finished);
        lock.lock();
        ++finished;
        moved.notify_all();
      }
      finishing = false;
    } catch (...) {
      std::lock_guard lock(mutex);
      broken = true;
      moved.notify_all();
      throw;
    }
  });
}

}  // namespace varve
