// SPDX-License-Identifier: MIT
#include "scarp/base/kept_memory.h"

#include <gtest/gtest.h>

namespace scarp {
namespace {

struct Own {
  int number = 3;
};

TEST(KeptMemory, NextVectorOfTheThreadReusesItAndIsEmpty) {
  const Own* memory = nullptr;
  {
    KeptVector<Own> first(1000);
    memory = first.data();
    first[7].number = 8;
  }
  KeptVector<Own> second;
  EXPECT_TRUE(second.empty());
  second.resize(1000);
  EXPECT_EQ(second.data(), memory);
  EXPECT_EQ(second[7].number, 3);
}

TEST(KeptMemory, SimultaneousVectorsDoNotShareIt) {
  { KeptVector<Own> first(100); }
  KeptVector<Own> second(100), third(100);
  EXPECT_NE(second.data(), third.data());
}

TEST(KeptMemory, LargeVectorsAreFreed) {
  std::vector<char> large(kMostKept + 1);
  keep(large);
  EXPECT_EQ(large.size(), kMostKept + 1);
  std::vector<char> next;
  borrow(next);
  EXPECT_LE(next.capacity(), kMostKept);
}

}  // namespace
}  // namespace scarp
