// SPDX-License-Identifier: Apache-2.0
/// Waits for changes of files. Watches their folders, since programs replace files by renaming others: Linux only.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace vmlight {

class FileWatch
{
public:
    FileWatch() = default;
    ~FileWatch();
    FileWatch(const FileWatch&) = delete;
    FileWatch& operator=(const FileWatch&) = delete;

    /// Why files cannot be watched here, or "".
    static std::string fault();

    /// Watch the folders where these files are, and from now on no others: those of links on the way to them too, and
    /// of a file that does not exist the nearest folder that does. Changes made on another machine, of a network's file
    /// system, are not seen.
    ///
    /// @returns false, with the reason in `error`, if a folder cannot be read or the system allows no more watches
    bool follow(const std::vector<std::string>& paths, std::string& error);

    /// Return once something in one of the folders has been written, replaced, removed or made, and then nothing for a
    /// moment; earlier if it goes on. Files that are being written count once they are closed;
    /// a new time of modification alone does not, as the bytes are the same.
    void wait();

private:
    bool read_events(int milliseconds);

    int m_descriptor = -1;
    std::map<int, std::string> m_folders; // by their watches
};

} // namespace vmlight
