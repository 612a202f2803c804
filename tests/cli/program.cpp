#include "tests/cli/program.h"

#include <fcntl.h>
#include <stdlib.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <iterator>

namespace textonbench {
namespace {

void redirect(int descriptor, const std::filesystem::path& file) {
  const int target = open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666);
  dup2(target, descriptor);
  close(target);
}

}  // namespace

pid_t start_program(const std::vector<std::string>& arguments, const Surroundings& surroundings) {
  const pid_t pid = fork();
  if (pid != 0) return pid;
  redirect(STDOUT_FILENO, surroundings.folder / "stdout");
  redirect(STDERR_FILENO, surroundings.folder / "stderr");
  if (chdir(surroundings.folder.c_str()) != 0) _exit(127);
  unsetenv("TEXTONBENCH_DATA");
  setenv("TEXTONBENCH_HOME", TEXTONBENCH_SOURCE_DIR, 1);
  for (const auto& [name, value] : surroundings.environment) setenv(name.c_str(), value.c_str(), 1);
  const auto hold_to = [](auto resource, std::size_t most) {
    const rlimit limit{most, most};
    if (most > 0) setrlimit(resource, &limit);
  };
  hold_to(RLIMIT_FSIZE, surroundings.largest_file);
  hold_to(RLIMIT_AS, surroundings.most_memory);
  std::vector<std::string> words = arguments;
  words.insert(words.begin(), TEXTONBENCH_PROGRAM);
  std::vector<char*> pointers;
  pointers.reserve(words.size() + 1);
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  execv(TEXTONBENCH_PROGRAM, pointers.data());
  _exit(127);
}

Outcome run_program(const std::vector<std::string>& arguments, const Surroundings& surroundings) {
  const pid_t pid = start_program(arguments, surroundings);
  int status = 0;
  waitpid(pid, &status, 0);
  return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), content_of(surroundings.folder / "stdout"),
          content_of(surroundings.folder / "stderr")};
}

std::string content_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace textonbench
