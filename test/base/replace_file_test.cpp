// SPDX-License-Identifier: MIT
#include "scarp/base/replace_file.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>

#include "base/refusal.h"
#include "scarp/base/error.h"

namespace scarp {
namespace {

namespace fs = std::filesystem;

void write(const fs::path& path, const std::string& text) { std::ofstream(path, std::ios::binary) << text; }

std::string read(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

// The text of the Error that the constructor throws; empty when it throws none.
std::string refusal(const std::string& path) {
  return test::refusal([&] { ReplaceFile{path}; });
}

// Root can write anywhere: drops that privilege during its lifetime.
class WithoutRoot {
 public:
  WithoutRoot() : root_(::geteuid() == 0) {
    if (root_ && ::setresuid(kNobody, kNobody, 0) != 0) throw std::runtime_error("setresuid failed");
  }
  ~WithoutRoot() {
    if (root_ && ::setresuid(0, 0, 0) != 0) std::abort();
  }
  WithoutRoot(const WithoutRoot&) = delete;
  WithoutRoot& operator=(const WithoutRoot&) = delete;

 private:
  static constexpr ::uid_t kNobody = 65534;
  bool root_;
};

class ReplaceFileTest : public testing::Test {
 protected:
  ReplaceFileTest() {
    std::string name = (fs::temp_directory_path() / "scarp-replace-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error("mkdtemp failed");
    folder_ = name;
    fs::permissions(folder_, fs::perms::others_read | fs::perms::others_exec, fs::perm_options::add);
  }
  ~ReplaceFileTest() override { fs::remove_all(folder_); }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  std::ptrdiff_t files() const { return std::distance(fs::directory_iterator(folder_), fs::directory_iterator()); }

  fs::path folder_;
};

TEST_F(ReplaceFileTest, CommitMovesTheFileIntoPlace) {
  {
    ReplaceFile file(path("a.png"));
    write(file.temporary_path(), "new");
    EXPECT_FALSE(fs::exists(path("a.png"))) << "there before commit()";
    file.commit();
    EXPECT_EQ(read(path("a.png")), "new");
  }
  EXPECT_EQ(read(path("a.png")), "new");
  EXPECT_EQ(files(), 1);
}

TEST_F(ReplaceFileTest, FollowsAndKeepsSymlinks) {
  write(path("a.png"), "old");
  fs::create_symlink("a.png", path("link.png"));
  ReplaceFile file(path("link.png"));
  write(file.temporary_path(), "new");
  file.commit();
  EXPECT_TRUE(fs::is_symlink(path("link.png")));
  EXPECT_EQ(read(path("a.png")), "new");
}

TEST_F(ReplaceFileTest, RejectsDevices) {
  EXPECT_NE(refusal("/dev/null").find("/dev/null: is a device"), std::string::npos);
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
}

TEST_F(ReplaceFileTest, CommitReplacesAnExistingFile) {
  write(path("a.png"), "old");
  ReplaceFile file(path("a.png"));
  write(file.temporary_path(), "new");
  EXPECT_EQ(read(path("a.png")), "old") << "touched before commit()";
  file.commit();
  EXPECT_EQ(read(path("a.png")), "new");
  EXPECT_EQ(files(), 1);
}

TEST_F(ReplaceFileTest, CommitKeepsPermissions) {
  const auto mode = [&] { return static_cast<int>(fs::status(path("a.png")).permissions()); };
  write(path("a.png"), "old");
  for (const int before : {0640, 0600, 0666}) {
    fs::permissions(path("a.png"), fs::perms(before));
    ReplaceFile file(path("a.png"));
    // Like writers that recreate the file.
    fs::remove(file.temporary_path());
    write(file.temporary_path(), "new");
    file.commit();
    EXPECT_EQ(mode(), before);
  }
}

TEST_F(ReplaceFileTest, WithoutCommitTheOldFileStays) {
  write(path("a.png"), "old");
  {
    const ReplaceFile file(path("a.png"));
    write(file.temporary_path(), "half of the n");
  }
  EXPECT_EQ(read(path("a.png")), "old");
  EXPECT_EQ(files(), 1);
}

TEST_F(ReplaceFileTest, TemporaryFileSharesFolderAndExtension) {
  const ReplaceFile file(path("heights.tif"));
  const fs::path temporary(file.temporary_path());
  EXPECT_EQ(temporary.parent_path(), folder_);
  EXPECT_EQ(temporary.extension(), ".tif");
  EXPECT_NE(temporary.filename(), "heights.tif");
}

TEST_F(ReplaceFileTest, BareNameMeansTheCurrentFolder) {
  const fs::path before = fs::current_path();
  fs::current_path(folder_);
  {
    ReplaceFile file("a.csv");
    write(file.temporary_path(), "x");
    file.commit();
  }
  fs::current_path(before);
  EXPECT_EQ(read(path("a.csv")), "x");
}

TEST_F(ReplaceFileTest, RejectsAnEmptyName) { EXPECT_NE(refusal(""), ""); }

TEST_F(ReplaceFileTest, ErrorNamesTheDirectory) {
  const std::string text = refusal(folder_.string());
  EXPECT_NE(text.find("is a directory"), std::string::npos) << text;
  EXPECT_EQ(files(), 0);
}

TEST_F(ReplaceFileTest, RejectsAMissingFolderWithoutCreatingIt) {
  const std::string text = refusal(path("missing/a.png"));
  EXPECT_NE(text.find("does not exist"), std::string::npos) << text;
  EXPECT_FALSE(fs::exists(path("missing")));
}

TEST_F(ReplaceFileTest, RejectsAReadOnlyFolderUpFront) {
  fs::permissions(folder_, fs::perms::owner_write | fs::perms::group_write, fs::perm_options::remove);
  std::string text;
  {
    const WithoutRoot user;
    text = refusal(path("a.png"));
  }
  fs::permissions(folder_, fs::perms::owner_write, fs::perm_options::add);
  EXPECT_NE(text.find("is not writable"), std::string::npos) << text;
  EXPECT_EQ(files(), 0);
}

TEST_F(ReplaceFileTest, RejectsAReadOnlyFile) {
  fs::permissions(folder_, fs::perms::all);
  write(path("a.png"), "old");
  fs::permissions(path("a.png"), fs::perms::owner_read | fs::perms::others_read);
  std::string text;
  {
    const WithoutRoot user;
    text = refusal(path("a.png"));
  }
  EXPECT_NE(text.find("is write-protected"), std::string::npos) << text;
  EXPECT_EQ(read(path("a.png")), "old");
}

TEST_F(ReplaceFileTest, ErrorsAreOneLineAndNameTheFile) {
  for (const std::string& name : {folder_.string(), path("missing/a.png")}) {
    const std::string text = refusal(name);
    EXPECT_EQ(text.find('\n'), std::string::npos) << text;
    EXPECT_NE(text.find(name + ": "), std::string::npos) << text;
  }
}

TEST_F(ReplaceFileTest, AbruptExitLeavesNoTemporaryFile) {
  write(path("kept.png"), "old");
  ReplaceFile first(path("kept.png"));
  {
    // Its slot in the list is reused.
    ReplaceFile whole(path("whole.png"));
    write(whole.temporary_path(), "new");
    whole.commit();
    const ReplaceFile dropped(path("dropped.png"));
  }
  const ReplaceFile second(path("b.png")), third(path("c.png"));
  EXPECT_EQ(files(), 5);
  EXPECT_EXIT((remove_temporary_files(), ::_exit(0)), testing::ExitedWithCode(0), "");
  EXPECT_EQ(files(), 2);
  EXPECT_EQ(read(path("kept.png")), "old");
  EXPECT_EQ(read(path("whole.png")), "new");
}

TEST_F(ReplaceFileTest, TemporaryFoldersAreDeletedWithTheirFiles) {
  write(path("a.png"), "old");
  {
    const TemporaryFolder folder(path("a.png"));
    for (const char* name : {"a.png", "a.png.aux.xml"}) write(fs::path(folder.name()) / name, "new");
    EXPECT_EQ(files(), 2);
  }
  EXPECT_EQ(files(), 1);
  EXPECT_EQ(read(path("a.png")), "old");
  EXPECT_NE(test::refusal([&] { TemporaryFolder{path("none/a.png")}; }).find("cannot create a folder"),
            std::string::npos);
}

TEST_F(ReplaceFileTest, TemporaryFoldersAreDeletedInASignalHandler) {
  const TemporaryFolder folder(path("a.png")), empty(path("b.png"));
  // More names than one read of the folder returns.
  for (int i = 0; i < 500; ++i) write(fs::path(folder.name()) / (std::string(20, 'x') + std::to_string(i)), "new");
  EXPECT_EXIT((remove_temporary_files(), ::_exit(0)), testing::ExitedWithCode(0), "");
  EXPECT_EQ(files(), 0);
}

}  // namespace
}  // namespace scarp
