// What a misspelt name is taken for.
#include "model/nearest_word.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace vibratory_alignment {
namespace {

const std::vector<std::string> kWords = {"trial", "accuracy", "frequency", "r1", "r2"};

TEST(NearestWord, is_one_slip_of_the_finger_away) {
  for (const char* mistyped : {"trail", "tral", "triall", "trual", "rtial", "trial"})
    EXPECT_EQ(nearest_word(mistyped, kWords), "trial") << mistyped;
}

TEST(NearestWord, of_a_long_word_may_differ_in_a_third_of_it) {
  EXPECT_EQ(nearest_word("freqency", kWords), "frequency");
  EXPECT_EQ(nearest_word("frequancie", kWords), "frequency");
  EXPECT_FALSE(nearest_word("frequancies", kWords));
  EXPECT_EQ(nearest_word("trails", kWords), "trial");
  EXPECT_FALSE(nearest_word("tarils", kWords));
}

TEST(NearestWord, is_the_first_of_those_equally_near) { EXPECT_EQ(nearest_word("r3", kWords), "r1"); }

TEST(NearestWord, of_something_else_is_none) {
  for (const char* mistyped : {"", "x", "something", "lairt"}) EXPECT_FALSE(nearest_word(mistyped, kWords)) << mistyped;
  EXPECT_FALSE(nearest_word(std::string(61, 'r'), {std::string(61, 'r')}));
}

TEST(DidYouMean, ends_a_message) {
  EXPECT_EQ(did_you_mean("trail", kWords), ", did you mean trial?");
  EXPECT_EQ(did_you_mean("something", kWords), "");
}

}  // namespace
}  // namespace vibratory_alignment
