// A program that runs beside this one, with a socket to it.
#pragma once

#include <chrono>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "manyworlds/batch.hpp"
#include "src/base/output_file.hpp"

namespace manyworlds::film {

// Thrown where GoOn says no.
struct Stopped {};

class Child {
 public:
  // words: the program's path, and its arguments. The socket is the child's descriptors `ends`;
  // what it prints goes into `log`, in a folder that is its temporary one; its other standard
  // streams are empty. Throws FilmError.
  Child(std::vector<std::string> words, const std::vector<int>& ends, std::filesystem::path log,
        GoOn go_on);
  // Ends it, with all that it has started, if it has not ended by itself.
  ~Child();
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  // Both wait, and throw Stopped. False: the child has closed its end.
  bool send(std::string_view bytes);
  // Whatever there is, at the end of `bytes`. Also false where there was nothing until `deadline`.
  using Time = std::chrono::steady_clock::time_point;
  bool receive(std::string& bytes, Time deadline);
  // No more is sent: the child reads to its end.
  void finish_sending();
  // Its exit code, 128 + signal, once it has ended; -1 where it has not until `deadline`. Throws
  // Stopped.
  int wait(Time deadline);

  const std::string& name() const { return name_; }
  // The last line of what it printed, with a space and a colon in front; or empty.
  std::string last_words() const;

 private:
  bool await(short events, Time deadline);

  std::string name_;
  std::filesystem::path log_;
  GoOn go_on_;
  Descriptor socket_;
  pid_t process_ = -1;
};

}  // namespace manyworlds::film
