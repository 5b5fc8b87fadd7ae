// SPDX-License-Identifier: MIT
// MagicaVoxel files through the command line.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "cli/program.h"
#include "output/read_png.h"
#include "scarp/source/vox_file.h"

namespace scarp {
namespace {

using test::run;

class CliVox : public testing::Test {
 protected:
  CliVox() {
    VoxFile file;
    file.version = 200;
    file.models = {{{3, 3, 3}, {}}};
    for (std::uint8_t i = 0; i < 9; ++i)
      file.models[0].voxels.push_back({static_cast<std::uint8_t>(i % 3), static_cast<std::uint8_t>(i / 3), 0, 216});
    file.nodes = {{0, {}, VoxTransform{1}},
                  {1, {}, VoxGroup{{2, 4}}},
                  {2, {}, VoxTransform{3}},
                  {3, {}, VoxShape{}},
                  {4, {{"_hidden", "1"}}, VoxTransform{5, -1, -1, {{{"_t", "0 0 9"}}}}},
                  {5, {}, VoxShape{}}};
    write_vox(model_, file);
  }

  std::string path(const std::string& name) const { return scratch_.path(name); }

  // One line on stderr with the fragment, no picture.
  void expect_refused(const std::vector<std::string>& arguments, const std::string& fragment) {
    const auto result = run(arguments);
    EXPECT_NE(result.status, 0);
    EXPECT_EQ(test::lines(result.err), 1) << result.err;
    EXPECT_NE(result.err.find(fragment), std::string::npos) << result.err;
    EXPECT_EQ(scratch_.files(), std::vector<std::string>{"model.vox"});
  }

  test::Scratch scratch_;
  std::string model_ = scratch_.path("model.vox");
};

TEST_F(CliVox, InfoSaysWhatIsInTheFile) {
  const auto text = run({"info", model_});
  EXPECT_EQ(text.status, 0) << text.err;
  EXPECT_NE(text.out.find("1 objects, 1 hidden"), std::string::npos) << text.out;
  const auto json = nlohmann::json::parse(run({"info", model_, "--json", "--hidden"}).out);
  EXPECT_EQ(json["version"], 200);
  EXPECT_EQ(json["models"][0]["voxels"], 9);
  EXPECT_EQ(json["instances"], 2);
  EXPECT_EQ(json["low"], (std::vector<int>{-1, -1, -1}));
  EXPECT_EQ(json["high"], (std::vector<int>{2, 2, 9}));
}

// The default palette's entry 216 is a pure red; from above, in full sun, it stays what it is.
TEST_F(CliVox, AllMarchesRenderTheSamePicture) {
  std::string first;
  for (const char* march :
       {"voxel-exhaustive", "voxel-planes", "voxel-spheres", "voxel-cubes", "voxel-octants", "voxel-bricks"}) {
    const std::string out = path(std::string(march) + ".png");
    const auto result = run({"render", model_, "-o", out, "--top", "--size", "30x30", "--march", march});
    ASSERT_EQ(result.status, 0) << result.err;
    if (first.empty()) first = test::text_of(out);
    EXPECT_EQ(test::text_of(out), first) << march;
  }
  const test::Rgb picture = test::read_png(path("voxel-bricks.png"));
  ASSERT_EQ(picture.width, 30);
  const std::uint8_t* middle = picture.pixel(15, 15);
  EXPECT_GT(middle[0], 200);
  EXPECT_EQ(middle[1], 0);
  EXPECT_EQ(middle[2], 0);
}

TEST_F(CliVox, SaysInOneLineWhatIsWrong) {
  const std::string out = path("out.png");
  expect_refused({"render", model_, "-o", out, "--march", "max-mip"}, "voxel-exhaustive, voxel-planes");
  expect_refused({"render", model_, "-o", out, "--look", "height"}, "there are: shaded, steps");
  expect_refused({"render", model_, model_, "-o", out}, "stands alone");
  expect_refused({"info", path("missing.vox")}, "cannot be opened");
  expect_refused({"cast", model_, "--rays", "x.csv", "-o", out}, "");
  std::string bytes = test::text_of(model_);
  bytes.resize(bytes.size() / 2);
  scratch_.write("model.vox", bytes);
  expect_refused({"render", model_, "-o", out}, "is cut off");
  scratch_.write("model.vox", "\xff\xd8\xff\xe0, a picture");
  expect_refused({"render", model_, "-o", out}, "ff d8 ff e0");
}

}  // namespace
}  // namespace scarp
