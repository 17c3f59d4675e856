#include "train_node/node_parameters.h"

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

namespace train_node {
namespace {

using XmlRpc::XmlRpcValue;

XmlRpcValue Number(double value) { return {value}; }

/// What is complained of once `read` has read its parameters.
template <class Read>
std::string Complaint(const XmlRpcValue& values, const Read& read) {
  NodeParameters parameters(values);
  read(parameters);
  try {
    parameters.ThrowIfWrong();
  } catch (const std::invalid_argument& e) {
    return e.what();
  }
  return "";
}

TEST(NodeParameters, DefaultsWhereThereAreNone) {
  NodeParameters parameters{XmlRpcValue()};
  EXPECT_EQ("a", parameters.Text("text", "a"));
  EXPECT_EQ("", parameters.Words("words"));
  EXPECT_TRUE(parameters.Flag("flag", true));
  EXPECT_EQ(7, parameters.Integer("integer", 7));
  EXPECT_EQ(0.5, parameters.NonNegative("number", 0.5));
  EXPECT_TRUE(parameters.IsFirstOf("choice", "stop", "go_on"));
  EXPECT_NO_THROW(parameters.ThrowIfWrong());
}

TEST(NodeParameters, ValuesOfTheRightTypeAreTaken) {
  XmlRpcValue values;
  values["text"] = std::string("b c");
  values["words"] = 3;
  values["flag"] = XmlRpcValue(false);
  values["integer"] = -4;
  values["number"] = 2;  // an integer is a number
  values["choice"] = std::string("go_on");
  NodeParameters parameters(values);
  EXPECT_EQ("b c", parameters.Text("text", "a"));
  EXPECT_EQ("3", parameters.Words("words"));
  EXPECT_FALSE(parameters.Flag("flag", true));
  EXPECT_EQ(-4, parameters.Integer("integer", 7));
  EXPECT_EQ(2.0, parameters.NonNegative("number", 0.5));
  EXPECT_FALSE(parameters.IsFirstOf("choice", "stop", "go_on"));
  EXPECT_NO_THROW(parameters.ThrowIfWrong());
}

TEST(NodeParameters, AWrongTypeIsAnErrorAndNotTheDefault) {
  XmlRpcValue values;
  values["record"] = std::string("no");
  values["pace"] = std::string("fast");
  values["out"] = 5;
  values["ranks"] = Number(2.5);
  values["detail"] = Number(1.0);
  const std::string complaint = Complaint(values, [](NodeParameters& p) {
    p.Flag("record", true);
    p.NonNegative("pace", 0.0);
    p.Text("out", "");
    p.Integer("ranks", 0);
    p.Words("detail");
  });
  EXPECT_EQ(
      "parameter record must be true or false, got the text 'no'\n"
      "parameter pace must be a plain number >= 0, got the text 'fast'\n"
      "parameter out must be text, got 5\n"
      "parameter ranks must be an integer, got 2.5\n"
      "parameter detail must be words separated by blanks, got 1",
      complaint);
}

TEST(NodeParameters, NumbersOutOfRange) {
  const double wrong[] = {-1.0, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()};
  for (const double value : wrong) {
    XmlRpcValue values;
    values["pace"] = Number(value);
    const std::string complaint = Complaint(values, [](NodeParameters& p) { p.NonNegative("pace", 0.0); });
    EXPECT_EQ(0u, complaint.find("parameter pace must be >= 0 and finite, got ")) << complaint;
  }
  XmlRpcValue values;
  values["ranks"] = -1;
  EXPECT_EQ("parameter ranks must be >= 0, got -1",
            Complaint(values, [](NodeParameters& p) { p.Integer("ranks", 0, 0); }));
}

TEST(NodeParameters, AnUnknownNameIsAnErrorWithTheLikelyOne) {
  XmlRpcValue values;
  values["realtime_factor"] = 1;
  values["zzz"] = 1;
  EXPECT_EQ(
      "parameter realtime_factor is not known; did you mean real_time_factor?\n"
      "parameter zzz is not known; known parameters: real_time_factor, record",
      Complaint(values, [](NodeParameters& p) {
        p.NonNegative("real_time_factor", 0.0);
        p.Flag("record", true);
      }));
}

TEST(NodeParameters, AChoiceIsOneOfTwoWords) {
  for (const XmlRpcValue& wrong : {XmlRpcValue(std::string("perhaps")), XmlRpcValue(true)}) {
    XmlRpcValue values;
    values["on_write_error"] = wrong;
    const std::string complaint =
        Complaint(values, [](NodeParameters& p) { p.IsFirstOf("on_write_error", "stop", "go_on"); });
    EXPECT_EQ(0u, complaint.find("parameter on_write_error must be stop or go_on, got ")) << complaint;
  }
}

}  // namespace
}  // namespace train_node
