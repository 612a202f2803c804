// The built program, run from a test.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace textonbench {

struct Outcome {
  int status = -1;  ///< exit status, or 128 + the signal that ended it
  std::string out, err;
};

struct Surroundings {
  std::filesystem::path folder;  ///< working folder; standard output and error are kept here too
  std::map<std::string, std::string> environment = {};
  std::size_t largest_file = 0;  ///< bytes that a file may have; 0: no limit
  std::size_t most_memory = 0;   ///< bytes of addresses that the program may take; 0: no limit
};

/// Starts the program with these arguments.
pid_t start_program(const std::vector<std::string>& arguments, const Surroundings& surroundings);
/// Starts it and waits for its end.
Outcome run_program(const std::vector<std::string>& arguments, const Surroundings& surroundings);

std::string content_of(const std::filesystem::path& file);

}  // namespace textonbench
