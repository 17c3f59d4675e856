// Runs a program and prints, as the last line of its output, the most memory that it had [bytes].
//
// What getrusage says of a child begins with the memory of the process that starts it, also after exec: a program that
// starts a program must be smaller. Hence a program of its own, which uses nothing but the C library.
//
// usage: peak_memory PROGRAM [ARGUMENT ...]      ends with the program's exit code
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fputs("usage: peak_memory PROGRAM [ARGUMENT ...]\n", stderr);
    return 2;
  }
  const pid_t program = fork();
  if (program == 0) {
    execvp(argv[1], argv + 1);
    std::perror(argv[1]);
    _exit(127);
  }
  int status = 0;
  rusage usage{};
  if (program < 0 || wait4(program, &status, 0, &usage) < 0) {
    std::perror("peak_memory");
    return 1;
  }
  std::printf("%ld\n", 1024 * usage.ru_maxrss);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}
