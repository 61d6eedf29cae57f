// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Files that lie, end early or cannot be written: one Error each, no crash, no memory by an unchecked number.
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>

#include <array>
#include <csignal>
#include <cstring>
#include <functional>

#include "image/atomic_file.h"
#include "image/exr_samples.h"
#include "image/limits.h"
#include "image/test_files.h"

namespace gloam {
namespace {

using test::Bytes;
using test::errorOf;
using test::ExrSample;
namespace fs = std::filesystem;

class BrokenExr : public test::FileTest {
 protected:
  // Small files of every form.
  std::vector<Bytes> samples() {
    std::vector<Bytes> files;
    for (int compression = 0; compression < Imf::NUM_COMPRESSION_METHODS; ++compression)
      for (const int tile : {0, 4}) {
        ExrSample sample{.width = 5, .height = 4, .compression = Imf::Compression(compression), .tile = tile};
        sample.attributes["owner"] = "x";
        test::writeSample(sample, path("a.exr"));
        files.push_back(bytesOf(path("a.exr")));
      }
    test::writeSeveralParts({.width = 5, .height = 4}, path("a.exr"));
    files.push_back(bytesOf(path("a.exr")));
    test::writeDeep(path("a.exr"));
    files.push_back(bytesOf(path("a.exr")));
    return files;
  }
  // Where the value of an attribute starts.
  static std::size_t attribute(const Bytes& bytes, const std::string& name, const std::string& type) {
    std::string pattern = name + std::string(1, '\0') + type + std::string(1, '\0');
    const auto at = std::search(bytes.begin(), bytes.end(), pattern.begin(), pattern.end());
    EXPECT_NE(at, bytes.end());
    return std::size_t(at - bytes.begin()) + pattern.size() + 4;
  }
  static void setWord(Bytes& bytes, std::size_t at, std::int32_t value) {
    std::memcpy(&bytes[at], &value, 4);
  }
};

TEST_F(BrokenExr, TruncatedAnywhereIsAnError) {
  const std::vector<Bytes> files = samples();
  for (std::size_t i = 0; i < files.size(); ++i) {
    const bool several = i == files.size() - 2;  // the last part, which is not read, may be missing
    for (std::size_t length = 0; length < files[i].size(); ++length) {
      const fs::path file = put("b.exr", Bytes(files[i].begin(), files[i].begin() + std::ptrdiff_t(length)));
      const std::string error = errorOf([&] { readExr(file); });
      if (several && error.empty()) continue;
      ASSERT_EQ(error.compare(0, file.string().size(), file.string()), 0)
          << length << " of " << files[i].size();
    }
  }
}

TEST_F(BrokenExr, DamagedBytesNeverCrash) {
  int pictures = 0, errors = 0;
  for (const Bytes& whole : samples())
    for (std::size_t at = 0; at < whole.size(); ++at) {
      Bytes damaged = whole;
      damaged[at] = std::array<std::uint8_t, 3>{0x00, 0x7f, 0xff}[at % 3];
      const fs::path file = put("b.exr", damaged);
      (errorOf([&] { readImage(file); }).empty() ? pictures : errors) += 1;
    }
  EXPECT_GT(pictures, 0);
  EXPECT_GT(errors, 0);
}

TEST_F(BrokenExr, ClaimsAreCheckedAgainstTheFile) {
  test::writeSample({}, path("a.exr"));
  const Bytes whole = bytesOf(path("a.exr"));
  const std::size_t data = attribute(whole, "dataWindow", "box2i"),
                    display = attribute(whole, "displayWindow", "box2i");
  const auto errorWith = [&](std::initializer_list<std::pair<std::size_t, std::int32_t>> words) {
    Bytes bytes = whole;
    for (const auto& [at, value] : words) setWord(bytes, at, value);
    return errorOf([&] { readImage(put("b.exr", bytes)); });
  };
  const auto has = [](const std::string& error, const char* text) {
    return error.find(text) != std::string::npos;
  };
  EXPECT_TRUE(has(errorWith({{data + 8, 16383}, {data + 12, 16383}}), "cannot hold that many pixels"));
  EXPECT_TRUE(has(errorWith({{data + 8, 99999}, {data + 12, 99999}}), "at most 268435456"));
  EXPECT_TRUE(has(errorWith({{data + 8, INT32_MAX}, {data + 0, INT32_MIN}}), "dataWindow"));
  EXPECT_TRUE(has(errorWith({{data + 8, -1}}), "at least 1 x 1"));
  EXPECT_TRUE(has(errorWith({{display + 8, 16383}, {display + 12, 16383}}), "out of proportion"));
  EXPECT_TRUE(has(errorWith({{display + 12, -5}}), "at least 1 x 1"));
  EXPECT_TRUE(has(errorWith({{data - 4, 1 << 30}}), "attribute dataWindow: 1073741824 bytes were claimed"));
  EXPECT_TRUE(has(errorWith({{data - 4, -1}}), "were claimed"));
  EXPECT_TRUE(has(errorWith({{0, 1}}), "not a picture"));
  EXPECT_TRUE(has(errorWith({{4, 99}}), "version"));
}

TEST_F(BrokenExr, TilesAreCheckedAgainstTheFile) {
  test::writeSample({.tile = 4}, path("a.exr"));
  Bytes bytes = bytesOf(path("a.exr"));
  const std::size_t tiles = attribute(bytes, "tiles", "tiledesc");
  for (const std::int32_t size : {0, -1, 1 << 30}) {
    setWord(bytes, tiles, size);
    EXPECT_NE(errorOf([&] { readImage(put("b.exr", bytes)); }).find("tiles of"), std::string::npos) << size;
  }
}

// Runs `work` in a process that may have 64 MiB more than it has now.
bool worksInLittleMemory(const std::function<void()>& work) {
  const pid_t child = fork();
  if (child == 0) {
    std::ifstream status("/proc/self/statm");
    rlim_t pages = 0;
    status >> pages;
    const rlim_t bytes = pages * rlim_t(sysconf(_SC_PAGESIZE)) + (rlim_t(64) << 20);
    const rlimit limit{bytes, bytes};
    if (setrlimit(RLIMIT_AS, &limit) != 0) _exit(3);
    alarm(10);
    try {
      work();
    } catch (const Error&) {
      _exit(0);
    } catch (...) {
      _exit(2);
    }
    _exit(1);
  }
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

TEST_F(BrokenExr, LittleMemoryIsAnErrorToo) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "sanitizers need the address space";
#endif
  // Believable sizes: enough bytes follow for what they claim.
  test::writeSample({.width = 3500, .height = 3000, .channels = {"R", "G", "B"}}, path("a.exr"));
  EXPECT_TRUE(worksInLittleMemory([&] { readImage(path("a.exr")); }));
  std::string hdr = "#?RADIANCE\n\n-Y 10000 +X 20000\n";
  hdr += std::string(std::size_t(1) << 20, '\2');
  EXPECT_TRUE(worksInLittleMemory([&] { readImage(put("a.hdr", hdr)); }));
}

class Refused : public test::FileTest {};

TEST_F(Refused, WhatIsNoPicture) {
  const auto error = [&](const fs::path& file) { return errorOf([&] { readImage(file); }); };
  EXPECT_NE(error(path("none.exr")).find("none.exr: there is no such file"), std::string::npos);
  EXPECT_NE(error(path("")).find("folder"), std::string::npos);
  EXPECT_NE(error(put("empty.exr", Bytes{})).find("the file is empty"), std::string::npos);
  EXPECT_NE(error(put("text.hdr", std::string("hello"))).find("not a picture"), std::string::npos);
  EXPECT_NE(error(put("gif.png", std::string("GIF89a"))).find("not a picture"), std::string::npos);
  EXPECT_NE(error("/dev/null").find("device"), std::string::npos);
}

TEST(OneLine, HoldsNothingThatSpoilsATerminalOrJson) {
  EXPECT_EQ(oneLine("a\nb\t\x1b[31m\x7f"), "a b  [31m ");
  EXPECT_EQ(oneLine("caf\xc3\xa9 \xe6\x97\xa5 \xff\xc3"), "caf\xc3\xa9 \xe6\x97\xa5 ??");
  EXPECT_LE(oneLine(std::string(10000, 'x')).size(), 200u);
}

class Unwritable : public test::FileTest {
 protected:
  std::string error(const fs::path& file) {
    return errorOf([&] { writeImage(test::samplePicture(64, 64, 3), file); });
  }
};

TEST_F(Unwritable, IsAnErrorThatNamesTheReason) {
  EXPECT_NE(error(path("none") / "a.png").find("none does not exist"), std::string::npos);
  EXPECT_NE(error(path("a.tga")).find(".exr, .hdr or .png"), std::string::npos);
  fs::create_directory(path("folder.png"));
  EXPECT_NE(error(path("folder.png")).find("folder"), std::string::npos);
  if (geteuid() != 0) {
    fs::permissions(path(""), fs::perms::owner_read | fs::perms::owner_exec);
    EXPECT_NE(error(path("a.png")).find("Permission denied"), std::string::npos);
    fs::permissions(path(""), fs::perms::owner_all);
  }
}

TEST_F(Unwritable, AFullDiskLeavesTheOldFileAndNothingElse) {
  for (const char* name : {"a.exr", "a.hdr", "a.png"}) {
    put(name, std::string("old"));
    const fs::path file = path(name);
    const pid_t child = fork();
    if (child == 0) {
      std::signal(SIGXFSZ, SIG_IGN);
      const rlimit limit{100, 100};
      setrlimit(RLIMIT_FSIZE, &limit);
      try {
        writeImage(test::samplePicture(64, 64, 3), file);
      } catch (const Error& error) {
        _exit(std::strstr(error.what(), "cannot write") ? 0 : 2);
      }
      _exit(1);
    }
    int status = 0;
    waitpid(child, &status, 0);
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << name << " " << status;
    EXPECT_EQ(bytesOf(file), (Bytes{'o', 'l', 'd'})) << name;
  }
  EXPECT_EQ(filesInFolder(), 3u);
}

TEST_F(Unwritable, WritingLeavesOneFileAndFollowsLinks) {
  EXPECT_EQ(error(path("a.png")), "");
  EXPECT_EQ(filesInFolder(), 1u);
  fs::create_symlink("a.png", path("link.png"));
  const Image small = test::samplePicture(2, 2, 3);
  writePng(small, path("link.png"));
  EXPECT_TRUE(fs::is_symlink(path("link.png")));
  EXPECT_EQ(readImage(path("a.png")).width, 2);
  EXPECT_EQ(filesInFolder(), 2u);
}

TEST_F(Unwritable, DevicesAreWrittenInPlace) {
  AtomicFile file("/dev/null");
  file.write("abc", 3);
  file.commit();
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
}

TEST_F(Unwritable, WithoutCommitNothingHappens) {
  put("a", std::string("old"));
  {
    AtomicFile file(path("a"));
    file.write("new", 3);
  }
  EXPECT_EQ(bytesOf(path("a")), (Bytes{'o', 'l', 'd'}));
  EXPECT_EQ(filesInFolder(), 1u);
}

}  // namespace
}  // namespace gloam
