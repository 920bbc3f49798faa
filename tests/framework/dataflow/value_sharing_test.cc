// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "oca/framework/dataflow/value.h"

namespace oca {
namespace value_sharing_test {

Location At(int line) { return {std::make_shared<const std::string>("file"), line, 1}; }

Value Tree() {
  Value::Map inner{{"gain", At(2), Value(1.5, At(2))}, {"name", At(3), Value("arm", At(3))}};
  Value::Map outer{{"field", At(1), Value(std::move(inner), At(1))},
                   {"list", At(4), Value(Value::List{Value(1.0, At(4))}, At(4))}};
  return Value(std::move(outer), At(1));
}

double GainOf(const Value& tree) {
  double gain = 0.0;
  tree.Find("field")->Find("gain")->number(gain);
  return gain;
}

TEST(ValueSharingTest, ACopySharesUntilItChanges) {
  const Value tree = Tree();
  Value copy = tree;
  EXPECT_TRUE(copy.Shares(tree));
  Value::Map& fields = *(*copy.map())[0].value.map();
  fields[0].value = Value(2.5, At(9));
  EXPECT_FALSE(copy.Shares(tree));
  EXPECT_EQ(GainOf(tree), 1.5);
  EXPECT_EQ(GainOf(copy), 2.5);
  EXPECT_TRUE(copy.Find("list")->Shares(*tree.Find("list")));  // nobody touched it
}

TEST(ValueSharingTest, OneOwnerChangesInPlace) {
  Value tree = Tree();
  const Value::Map* const before = std::as_const(tree).map();
  EXPECT_EQ(tree.map(), before);
}

TEST(ValueSharingTest, EqualIsNotShared) {
  EXPECT_FALSE(Tree().Shares(Tree()));
  EXPECT_FALSE(Value(1.0, At(1)).Shares(Value(1.0, At(1))));
}

TEST(ValueSharingTest, StandsElsewhereWithTheSameContent) {
  const Value tree = Tree();
  const Value moved = tree.At(At(7));
  EXPECT_EQ(moved.location().line, 7);
  EXPECT_EQ(tree.location().line, 1);
  EXPECT_TRUE(moved.Shares(tree));
}

TEST(ValueSharingTest, ThreadsChangeCopiesOfOneTree) {
  const Value tree = Tree();
  std::vector<std::thread> threads;
  std::vector<Value> copies(4, tree);
  for (std::size_t t = 0; t < copies.size(); ++t) {
    threads.emplace_back([&copy = copies[t], t] {
      for (int i = 0; i < 200; ++i) {
        (*(*copy.map())[0].value.map())[0].value = Value(static_cast<double>(t), At(1));
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  for (std::size_t t = 0; t < copies.size(); ++t) EXPECT_EQ(GainOf(copies[t]), t);
  EXPECT_EQ(GainOf(tree), 1.5);
}

}  // namespace value_sharing_test
}  // namespace oca
