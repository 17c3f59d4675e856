#include "ltd_master/settings.h"

#include <gtest/gtest.h>

#include <stdexcept>

namespace ltd_master {
namespace {

using Settings = std::vector<std::string>;

std::string Complaint(const std::string& text) {
  try {
    SplitSettings(text);
  } catch (const std::invalid_argument& e) {
    return e.what();
  }
  return "";
}

TEST(Settings, AreSeparatedByBlanks) {
  EXPECT_EQ(Settings{}, SplitSettings(""));
  EXPECT_EQ(Settings{}, SplitSettings(" \t\n"));
  EXPECT_EQ((Settings{"duration_s=2", "model=ltd", "a[0].b=-1e3"}),
            SplitSettings("  duration_s=2 model=ltd\ta[0].b=-1e3 "));
}

TEST(Settings, ValuesHoldQuotedTextListsAndMaps) {
  EXPECT_EQ((Settings{"description=\"two words\"", "dt_s=0.001"}),
            SplitSettings("description=\"two words\" dt_s=0.001"));
  EXPECT_EQ((Settings{"description='it''s [ here'"}), SplitSettings("description='it''s [ here'"));
  EXPECT_EQ((Settings{R"(description="a \" b")", "x=1"}), SplitSettings(R"(description="a \" b" x=1)"));
  EXPECT_EQ((Settings{"commands=[{time_s: 2, kind: emergency}, {time_s: 5, kind: 'full [ service'}]", "x=1"}),
            SplitSettings("commands=[{time_s: 2, kind: emergency}, {time_s: 5, kind: 'full [ service'}] x=1"));
  EXPECT_EQ((Settings{"train={base: paper_242, name: Anna's train}"}),
            SplitSettings("train={base: paper_242, name: Anna's train}"));
  EXPECT_EQ((Settings{"description=Anna's", "x=1"}), SplitSettings("description=Anna's x=1"));
}

TEST(Settings, WhatIsNotClosedOrNoSettingIsRefused) {
  EXPECT_EQ("set: [ is not closed in: a=[1, 2", Complaint("a=[1, 2"));
  EXPECT_EQ("set: ] closes nothing in: a=1]", Complaint("a=1]"));
  EXPECT_EQ("set: } closes nothing in: a=[1}", Complaint("a=[1}"));
  EXPECT_EQ("set: the quote \" is not closed in: \"b c", Complaint("a=\"b c"));
  EXPECT_EQ("set: duration_s must be a path, '=' and a value", Complaint("duration_s"));
}

TEST(Settings, TheExampleInTheMessageIsUnderstood) {
  const std::string complaint = Complaint("description=two words");
  const std::string lead = "as in ";
  ASSERT_NE(std::string::npos, complaint.find(lead)) << complaint;
  const std::string example = complaint.substr(complaint.find(lead) + lead.size());
  EXPECT_EQ((Settings{"description=\"two words\""}), SplitSettings(example));
}

}  // namespace
}  // namespace ltd_master
