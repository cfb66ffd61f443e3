#pragma once
// Runs the built program as a user would: words in, exit code and text out.

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/ioctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "support.h"

namespace lambent::test {

struct ProgramResult {
  int exit_code = -1;  ///< -1 where a signal ended it.
  std::string out, err;
};

/// A program that is running; its output goes to files, so that it never waits for us.
class RunningProgram {
 public:
  /// Start `words`, the first of which is the program's path, in `folder`.
  RunningProgram(const std::vector<std::string>& words, const std::string& folder) {
    posix_spawn_file_actions_t actions;
    ::posix_spawn_file_actions_init(&actions);
    ::posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    add_output(actions, STDOUT_FILENO, files_.file("out"));
    add_output(actions, STDERR_FILENO, files_.file("err"));
    ::posix_spawn_file_actions_addchdir_np(&actions, folder.c_str());
    pid_ = spawn(words, actions);
    ::posix_spawn_file_actions_destroy(&actions);
  }
  ~RunningProgram() {
    if (pid_ <= 0) return;
    ::kill(pid_, SIGKILL);
    ::waitpid(pid_, nullptr, 0);
  }
  RunningProgram(const RunningProgram&) = delete;
  RunningProgram& operator=(const RunningProgram&) = delete;

  void send(int signal) const { ::kill(pid_, signal); }

  /// Wait until `text` is on standard error; false where the program ends first.
  bool waits_for(const std::string& text) {
    for (;;) {
      siginfo_t info{};
      ::waitid(P_PID, id_t(pid_), &info, WEXITED | WNOHANG | WNOWAIT);
      if (read_text(files_.file("err")).find(text) != std::string::npos) return true;
      if (info.si_pid == pid_) return false;
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
  }

  ProgramResult wait() {
    int status = 0;
    ::waitpid(std::exchange(pid_, 0), &status, 0);
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read_text(files_.file("out")),
            read_text(files_.file("err"))};
  }

  static pid_t spawn(const std::vector<std::string>& words, posix_spawn_file_actions_t& actions) {
    std::vector<char*> argv;
    for (const std::string& word : words) argv.push_back(const_cast<char*>(word.c_str()));
    argv.push_back(nullptr);
    pid_t pid = 0;
    if (::posix_spawn(&pid, argv[0], &actions, nullptr, argv.data(), environ) != 0)
      throw std::runtime_error("cannot start " + words[0]);
    return pid;
  }

 private:
  static void add_output(posix_spawn_file_actions_t& actions, int fd, const std::string& path) {
    write_text(path, "");
    ::posix_spawn_file_actions_addopen(&actions, fd, path.c_str(), O_WRONLY | O_TRUNC, 0);
  }

  TemporaryDirectory files_;
  pid_t pid_ = 0;
};

/// The program's path, then `words`.
inline std::vector<std::string> program_and(std::vector<std::string> words) {
  words.insert(words.begin(), LAMBENT_PROGRAM);
  return words;
}

/// Run the program with `words` in `folder` to its end.
inline ProgramResult run_program(const std::vector<std::string>& words, const std::string& folder) {
  return RunningProgram(program_and(words), folder).wait();
}

/// Run a line of shell, in which $LAMBENT is the program: for pipes and closed streams.
inline ProgramResult run_shell(const std::string& line, const std::string& folder) {
  ::setenv("LAMBENT", LAMBENT_PROGRAM, 1);
  return RunningProgram({"/bin/sh", "-c", line}, folder).wait();
}

/// Run the program with a terminal of `width` columns as its standard error; `err` holds what the terminal
/// got.
inline ProgramResult run_on_terminal(const std::vector<std::string>& words, const std::string& folder,
                                     int width) {
  const int terminal = ::posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC);
  if (terminal < 0 || ::grantpt(terminal) != 0 || ::unlockpt(terminal) != 0)
    throw std::runtime_error("cannot open a terminal");
  winsize size{};
  size.ws_row = 24;
  size.ws_col = static_cast<unsigned short>(width);
  ::ioctl(terminal, TIOCSWINSZ, &size);
  ::setenv("TERM", "xterm", 1);

  posix_spawn_file_actions_t actions;
  ::posix_spawn_file_actions_init(&actions);
  ::posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  ::posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, ::ptsname(terminal), O_RDWR | O_NOCTTY, 0);
  ::posix_spawn_file_actions_addchdir_np(&actions, folder.c_str());
  const pid_t pid = RunningProgram::spawn(program_and(words), actions);
  ::posix_spawn_file_actions_destroy(&actions);

  ProgramResult result;
  char buffer[4096];
  for (ssize_t n; (n = ::read(terminal, buffer, sizeof buffer)) > 0;)
    result.err.append(buffer, std::size_t(n));
  int status = 0;
  ::waitpid(pid, &status, 0);
  ::close(terminal);
  result.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return result;
}

}  // namespace lambent::test
