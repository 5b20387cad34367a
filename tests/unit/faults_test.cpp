// A library that breaks down over a file.
#include <gtest/gtest.h>

#include <csignal>
#include <cstdlib>

#include "base/foreign_code.h"
#include "signals.h"

namespace varve {
namespace {

TEST(Faults, OfALibraryEndWithTheSentenceForTheFile) {
  testing::GTEST_FLAG(death_test_style) = "threadsafe";
  for (const int signal : {SIGSEGV, SIGABRT, SIGFPE})
    EXPECT_EXIT(
        {
          cli::watch_faults();
          const InForeignCode outer("'shot.0001.exr' is fine");
          const InForeignCode inner("'shot.0007.exr' is damaged");
          raise(signal);
        },
        testing::ExitedWithCode(3), "varve: error: 'shot.0007.exr' is damaged\n");
}

TEST(Faults, OfOursEndAsEver) {
  testing::GTEST_FLAG(death_test_style) = "threadsafe";
  EXPECT_EXIT(
      {
        cli::watch_faults();
        { const InForeignCode past("'shot.0007.exr' is damaged"); }
        raise(SIGSEGV);
      },
      testing::KilledBySignal(SIGSEGV), "");
}

}  // namespace
}  // namespace varve
