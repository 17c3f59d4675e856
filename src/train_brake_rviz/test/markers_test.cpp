#include "train_brake_rviz/markers.h"

#include <gtest/gtest.h>

namespace train_brake_rviz {
namespace {

using visualization_msgs::Marker;
using visualization_msgs::MarkerArray;

Drawing BoxAndTexts(const std::vector<std::string>& words) {
  Drawing drawing;
  drawing.Box({1.0, 2.0, 3.0, 4.0}, palette::kOrange);
  for (const std::string& text : words) drawing.Write({5.0, 6.0}, Align::kCentre, 2.0, text);
  return drawing;
}

MarkerArray Markers(MarkerWriter& writer, const Drawing& drawing) {
  MarkerArray out;
  writer.Append("part", drawing, out);
  return out;
}

TEST(MarkerWriter, MakesOneListOfTrianglesAndTheTexts) {
  MarkerWriter writer("board");
  const MarkerArray out = Markers(writer, BoxAndTexts({"speed"}));
  ASSERT_EQ(2u, out.markers.size());
  const Marker &shapes = out.markers[0], &words = out.markers[1];
  EXPECT_EQ(Marker::TRIANGLE_LIST, shapes.type);
  EXPECT_EQ("board", shapes.header.frame_id);
  EXPECT_EQ(6u, shapes.points.size());
  EXPECT_EQ(6u, shapes.colors.size());
  EXPECT_FLOAT_EQ(palette::kOrange.red, shapes.colors[0].r);
  EXPECT_EQ(Marker::TEXT_VIEW_FACING, words.type);
  EXPECT_EQ("speed", words.text);
  EXPECT_EQ(5.0, words.pose.position.x);
  EXPECT_EQ(6.0, words.pose.position.z);
  EXPECT_LT(words.pose.position.y, shapes.points[0].y);  // nearer to the viewer
}

TEST(MarkerWriter, SendsOnlyWhatHasChanged) {
  MarkerWriter writer("board");
  Markers(writer, BoxAndTexts({"1.0 s", "fixed"}));
  EXPECT_TRUE(Markers(writer, BoxAndTexts({"1.0 s", "fixed"})).markers.empty());
  const MarkerArray out = Markers(writer, BoxAndTexts({"1.1 s", "fixed"}));
  ASSERT_EQ(1u, out.markers.size());
  EXPECT_EQ("1.1 s", out.markers[0].text);
  writer.Refresh();
  EXPECT_EQ(3u, Markers(writer, BoxAndTexts({"1.1 s", "fixed"})).markers.size());
}

TEST(MarkerWriter, RemovesWhatIsGone) {
  MarkerWriter writer("board");
  Markers(writer, BoxAndTexts({"a", "b", "c"}));
  const MarkerArray out = Markers(writer, Drawing());
  ASSERT_EQ(4u, out.markers.size());
  for (const Marker& marker : out.markers) EXPECT_EQ(Marker::DELETE, marker.action);
}

}  // namespace
}  // namespace train_brake_rviz
