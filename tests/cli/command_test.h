// SPDX-License-Identifier: Apache-2.0
/// Command lines of the executables, run in this process by their own mains. (What takes a process is in
/// process_test.py.)
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <string>
#include <vector>

namespace vmlight {

inline const std::string kQuad = "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvn 0 0 1\n"
                                 "f 1/1/1 2/2/1 3/3/1 4/4/1\n";
inline const std::string kQuadWithoutUv = "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nf 1 2 3\n";
inline const std::string kData = VMLIGHT_TEST_DATA;
inline const std::string kSpot = kData + "/spot.obj";
inline const std::string kSky = kData + "/studio_small_03.hdr";
inline const std::string kConfig = VMLIGHT_TEST_OCIO;

/// Of all channels and pixels of a file's first image.
struct Pixels
{
    int width = 0, height = 0, channels = 0;
    std::vector<float> values;

    float least() const;
    float greatest() const;
};

/// What a run ended with.
struct Result
{
    int code = -1;
    std::string out, err;

    std::string all() const { return out + err; }
};

/// How often `part` occurs in `text`.
size_t count(const std::string& text, const std::string& part);

/// Each test runs in a temporary folder of its own, the current one.
///
/// A command line is written as in a shell: blanks part words, single quotes keep them together. {spot}, {sky} and
/// {config} stand for tests/data/spot.obj, tests/data/studio_small_03.hdr and the bundled OCIO config.
class CommandTest : public testing::Test
{
protected:
    CommandTest();
    ~CommandTest() override;

    Result run(const std::string& line) const;
    Result run_words(const std::vector<std::string>& words) const;
    /// Expects exit code 0; returns all that was printed.
    std::string done(const std::string& line) const;
    /// Expects `code`, an error that holds `text`, and a folder in which nothing has changed.
    void refused(int code, const std::string& text, const std::string& line) const;
    void refused_words(int code, const std::string& text, const std::vector<std::string>& words) const;

    std::string path(const std::string& name) const { return m_folder + "/" + name; }
    /// Writes a file, a new one even if there is one. Returns its name.
    std::string write(const std::string& name, const std::string& bytes = "") const;
    std::string read(const std::string& name) const;
    bool exists(const std::string& name) const;
    void remove(const std::string& name) const;
    /// All names in a folder that begin with `start`, sorted.
    std::vector<std::string> names(const std::string& start = "", const std::string& folder = ".") const;
    /// Path and bytes of each file.
    std::map<std::string, std::string> contents() const;

    Pixels pixels(const std::string& name, int subimage = 0) const;
    /// The channel visibility alone.
    Pixels visibility(const std::string& name) const;
    void expect_same_pixels(const std::string& a, const std::string& b, float tolerance) const;
    void expect_finite(const std::string& name) const;
    /// "" if the image has no such attribute.
    std::string attribute(const std::string& name, const std::string& attribute) const;
    std::vector<std::string> channel_names(const std::string& name) const;

    /// Writes vm.exr, of an open quad, and quad.obj.
    void make_vismap() const;
    void make_sky(const std::vector<float>& color, const std::string& name = "sky.exr", int width = 16,
                  int height = 8) const;

    /// Writes `src`, resized to 32x32.
    void shrink(const std::string& src, const std::string& dst) const;

private:
    std::string m_folder;
    int m_before;
};

} // namespace vmlight
