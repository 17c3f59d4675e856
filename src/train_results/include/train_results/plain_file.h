#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>

#include "train_dynamics/numeric/stream_digest.h"

namespace train_results {

/// Opens a file that a user has named for reading: not a folder, pipe or device, which might never end.
/// @throws std::invalid_argument that names the file and says what is wrong
std::ifstream OpenPlainFile(const std::filesystem::path& file);

/// The whole of such a file. @throws std::invalid_argument, also if it has more than max_bytes
std::string ReadPlainFile(const std::filesystem::path& file, std::uint64_t max_bytes);

/// Adds bytes [from, to) of such a file to a digest. @throws std::invalid_argument, also if it is shorter
void AddToDigest(const std::filesystem::path& file, std::uint64_t from, std::uint64_t to,
                 train_dynamics::StreamDigest& digest);

/// Why a file could not be written, in words for users: "No space left on device", ... @param error  errno
std::string WriteFailure(int error);

/// Waits until all data written to a file is on the disk. @throws std::runtime_error
void SyncFile(const std::filesystem::path& file);

/// Writes a whole file or nothing; once it returns, the file survives a loss of power.
/// @throws std::runtime_error that names the file and the reason
void WriteFile(const std::filesystem::path& file, const std::string& text);

}  // namespace train_results
