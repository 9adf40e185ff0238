// What the machine alone takes for a node's rate: a program that wakes up a thousand times a second, and one that then
// also sends messages over TCP to a process that waits for them in one thread.
//
//   bare_sender SECONDS MESSAGES BYTES     prints the CPU time of the sender per second: a share of a core
#include <netinet/in.h>
#include <sys/epoll.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <vector>

namespace {

constexpr long kInterval = 1'000'000;  ///< [ns]
constexpr long kSecond = 1'000'000'000;

[[noreturn]] void fail(const char* what) {
  std::perror(what);
  std::exit(1);
}

double cpu_now() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Reads from all sockets until the first is closed.
void receive(const std::vector<int>& sockets) {
  const int poll = epoll_create1(0);
  for (const int socket : sockets) {
    epoll_event event{};
    event.events = EPOLLIN;
    event.data.fd = socket;
    epoll_ctl(poll, EPOLL_CTL_ADD, socket, &event);
  }
  epoll_event ready{};
  std::vector<char> bytes(65536);
  while (epoll_wait(poll, &ready, 1, -1) == 1)
    if (read(ready.data.fd, bytes.data(), bytes.size()) <= 0) return;
}

/// Connections to a process of their own that receives.
std::vector<int> connect_receiver(int count) {
  if (count == 0) return {};
  const int listener = socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  auto* const any = reinterpret_cast<sockaddr*>(&address);
  if (bind(listener, any, size) != 0 || listen(listener, count) != 0 || getsockname(listener, any, &size) != 0)
    fail("listen");
  std::vector<int> ends(static_cast<std::size_t>(count));
  if (fork() == 0) {
    for (int& end : ends) {
      end = socket(AF_INET, SOCK_STREAM, 0);
      if (connect(end, any, size) != 0) fail("connect");
    }
    receive(ends);
    std::_Exit(0);
  }
  for (int& end : ends) end = accept(listener, nullptr, nullptr);
  return ends;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) {
    std::fprintf(stderr, "usage: bare_sender SECONDS MESSAGES BYTES\n");
    return 2;
  }
  const double seconds = std::atof(argv[1]);
  const std::vector<int> sockets = connect_receiver(std::atoi(argv[2]));
  const std::vector<char> message(static_cast<std::size_t>(std::atoi(argv[3])));

  timespec due{};
  clock_gettime(CLOCK_MONOTONIC, &due);
  const long turns = static_cast<long>(seconds * kSecond / kInterval);
  const double start = cpu_now();
  for (long turn = 0; turn < turns; ++turn) {
    due.tv_nsec += kInterval;
    if (due.tv_nsec >= kSecond) {
      due.tv_nsec -= kSecond;
      ++due.tv_sec;
    }
    clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &due, nullptr);
    for (const int socket : sockets)
      if (send(socket, message.data(), message.size(), 0) < 0) fail("send");
  }
  std::printf("%.5f\n", (cpu_now() - start) / seconds);
  for (const int socket : sockets) close(socket);
  while (wait(nullptr) > 0) {
  }
  return 0;
}
