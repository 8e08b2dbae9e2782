// SPDX-License-Identifier: Apache-2.0
#include "tests/rig/lab_bench.hpp"

#include <CppUTest/TestHarness.h>
#include <fcntl.h>
#include <linux/can/error.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <sstream>
#include <vector>

#include "firmware/can/can_map.hpp"

namespace hotfire::test {
namespace {

namespace can = firmware::can;

constexpr double kPistonPerCurrent = 5.0;  ///< [m/A]: piston_per_command / current_per_command

const char* const kUsualImage =
    "schema 1\ntopology lab\nactuators 1\npiston_per_command 0.5\ncurrent_per_command 0.1\ncurrent_per_error 0\n"
    "current_limit 0.02\napproach_rate 1\nrest_speed 0.001\nstopping_time 1\n"
    "limits.command_age 1\nlimits.reading_age 1\nlimits.lowest_reading -0.15\nlimits.highest_reading 0.15\n"
    "limits.disagreement 0.001\nlimits.lowest_position -0.06\nlimits.highest_position 0.06\nlimits.command_rate 100\n"
    "limits.speed 1000\nlimits.speed_time 0.01\nlimits.read_back_time 0.5\ninterlock.debounce 0.03\n"
    "interlock.start_hold 0\ninterlock.longest_press 60\ninterlock.least_armed 1\ninterlock.arming_timeout 60\n"
    "limits.position_error 0.005\nlimits.position_error_time 5\nlimits.overruns 1000000\n"
    "line.emergency_stop estop\nline.hydraulic_enable hydraulic\nline.arm arm\nline.start start\nline.supply supply\n"
    "line.heartbeat heartbeat\nline.fault fault\n"
    "segment.0.duration 100000\nsegment.0.from 0\nsegment.0.to 0\nsegment.0.amplitude 0.05\nsegment.0.frequency 0.5\n"
    "segment.0.last_frequency 0.5\n";

/// The usual image with the lines of the same keys replaced.
std::string image_with(const std::string& changes) {
  std::istringstream usual(kUsualImage);
  std::string image = changes;
  for (std::string line; std::getline(usual, line);) {
    const std::string key = line.substr(0, line.find(' ') + 1);
    if (("\n" + changes).find("\n" + key) == std::string::npos) {
      image += line + "\n";
    }
  }
  return image;
}

std::string bank_folder;

void pause() { std::this_thread::sleep_for(std::chrono::milliseconds(2)); }

}  // namespace

void shell(const std::string& command) {
  if (std::system((". /rig/helpers; " + command).c_str()) != 0) {
    FAIL(command.c_str());
  }
}

void wait_until(const std::string& what, const std::function<bool()>& is_so) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  while (!is_so()) {
    if (std::chrono::steady_clock::now() > end) {
      FAIL(("waited in vain for " + what).c_str());
    }
    pause();
  }
}

SensorNode::SensorNode() : socket_(socket(PF_CAN, SOCK_RAW, CAN_RAW)) {
  sockaddr_can address{};
  address.can_family = AF_CAN;
  address.can_ifindex = static_cast<int>(if_nametoindex("can0"));
  CHECK_EQUAL(0, bind(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address));
  thread_ = std::thread([this] { serve(); });
}

SensorNode::~SensorNode() {
  ended_ = true;
  thread_.join();
  close(socket_);
}

void SensorNode::serve() {
  constexpr int kLookEveryMs = 50;
  while (!ended_) {
    pollfd ready{socket_, POLLIN, 0};
    can_frame seen{};
    const bool any = poll(&ready, 1, kLookEveryMs) > 0;
    quiet += any ? 0 : 1;
    if (!any || recv(socket_, &seen, sizeof seen, MSG_DONTWAIT) != sizeof seen) {
      continue;
    }
    hal::CanFrame frame;
    frame.id = {seen.can_id, false};
    frame.length = seen.len;
    std::copy_n(seen.data, seen.len, frame.data.begin());
    take(frame);
  }
}

void SensorNode::take(const hal::CanFrame& frame) {
  std::array<double, 8> values{};
  std::uint8_t counter = 0;
  if (can::decode(can::heartbeat::kMessage, frame, values, counter) == can::Decoding::good) {
    state = static_cast<firmware::RigState>(values[can::heartbeat::state]);
    ++heartbeats;
  } else if (can::decode(can::servovalve_command::kMessage, frame, values, counter) == can::Decoding::good) {
    const firmware::RigState said = state;
    commands_when_not_driving += said == firmware::RigState::safe || said == firmware::RigState::faulted ? 1 : 0;
    position_ = mode == Mode::jammed ? position_ : kPistonPerCurrent * values[0];
    ++commands;
  } else if (can::decode(can::sync::kMessage, frame, values, counter) == can::Decoding::good && mode != Mode::silent) {
    answer();
  }
}

void SensorNode::answer() {
  hal::CanFrame frame;
  const double first = position_ + offset;
  can::encode(can::piston_1::kMessage, std::array{first, first + second_offset}, counter_, frame);
  frame.data[3] ^= mode == Mode::damaged ? 1 : 0;
  send(frame);
  if (mode == Mode::doubled || mode == Mode::surplus) {
    counter_ += mode == Mode::surplus ? 1 : 0;
    can::encode(can::piston_1::kMessage, std::array{0.0, 0.0}, counter_, frame);
    send(frame);
  }
  if (sends_load_pressure) {
    can::encode(can::load_pressures::kMessage, std::array{load_pressure.load(), 0.0}, counter_, frame);
    send(frame);
  }
  ++counter_;
}

void SensorNode::send_command() const {
  hal::CanFrame frame;
  can::encode(can::servovalve_command::kMessage, std::array{0.0, 0.0}, 0, frame);
  send(frame);
}

void SensorNode::send(const hal::CanFrame& frame) const {
  can_frame sent{};
  sent.can_id = frame.id.value;
  sent.len = frame.length;
  std::copy_n(frame.data.begin(), frame.length, sent.data);
  // While the bus is down nothing can be answered.
  static_cast<void>(!write(socket_, &sent, sizeof sent));
}

bool SensorNode::report_bus_off() const {
  can_frame frame{};
  frame.can_id = CAN_ERR_FLAG | CAN_ERR_BUSOFF;
  frame.len = CAN_ERR_DLC;
  return write(socket_, &frame, sizeof frame) == sizeof frame;
}

LabProgram::LabProgram(const std::string& changes, const std::string& options) {
  std::ofstream("/tmp/lab.image") << image_with(changes);
  process_ = fork();
  if (process_ == 0) {
    const std::string command =
        "exec hotfire-rt lab --rehearsal --image /tmp/lab.image --bus can0 --gpio rig --period-us 10000 --warm-up 0 "
        "--overwrite --record " +
        std::string(kRecording) + " " + options + " >/tmp/lab.out 2>&1";
    execl("/bin/sh", "sh", "-c", command.c_str(), nullptr);
    _exit(127);
  }
  // The lines are there when the heartbeat moves; requesting them has pulled the inputs down.
  wait_for_beats(2);
  pull(kStopLine, true);
  pull(kHydraulicLine, true);
  wait_for_beats(3);
}

LabProgram::~LabProgram() {
  if (process_ > 0) {
    kill(process_, SIGKILL);
    waitpid(process_, nullptr, 0);
  }
}

void LabProgram::signal(int number) const { kill(process_, number); }

void LabProgram::change_memory(double from, double to) const {
  const std::string folder = "/proc/" + std::to_string(process_);
  const int memory = open((folder + "/mem").c_str(), O_RDWR);
  std::ifstream maps(folder + "/maps");
  int changed = 0;
  for (std::string line; std::getline(maps, line);) {
    if (!line.ends_with("[heap]")) {
      continue;
    }
    std::istringstream fields(line);
    off_t begin = 0;
    off_t end = 0;
    char dash = 0;
    fields >> std::hex >> begin >> dash >> end;
    std::vector<double> values(static_cast<std::size_t>(end - begin) / sizeof(double));
    CHECK_EQUAL(end - begin, pread(memory, values.data(), values.size() * sizeof(double), begin));
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (std::bit_cast<std::uint64_t>(values[i]) == std::bit_cast<std::uint64_t>(from)) {
        const auto place = static_cast<off_t>(i * sizeof(double));
        changed += pwrite(memory, &to, sizeof to, begin + place) == sizeof to ? 1 : 0;
      }
    }
  }
  close(memory);
  CHECK(changed > 0);
}

int LabProgram::wait() {
  int status = 0;
  wait_until("the end of the program", [&] { return waitpid(process_, &status, WNOHANG) == process_; });
  process_ = -1;
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

std::string LabProgram::output() const {
  std::ifstream file("/tmp/lab.out");
  return {std::istreambuf_iterator<char>(file), {}};
}

void bank_up() {
  shell("lab_bank_up");
  std::string device;
  std::string chip;
  std::getline(std::ifstream("/sys/kernel/config/gpio-sim/rig/dev_name"), device);
  std::getline(std::ifstream("/sys/kernel/config/gpio-sim/rig/bank0/chip_name"), chip);
  bank_folder = "/sys/devices/platform/" + device + "/" + chip;
}

void bank_down() {
  shell("clean_up");
  std::string().swap(bank_folder);
}

namespace {

/// Where the kernel shows the outside of a line of the bank.
std::string outside(Line line) { return bank_folder + "/sim_gpio" + std::to_string(line); }

}  // namespace

bool carries(Line line) {
  int value = -1;
  std::ifstream(outside(line) + "/value") >> value;
  return value == 1;
}

void pull(Line line, bool up) { std::ofstream(outside(line) + "/pull") << (up ? "pull-up" : "pull-down"); }

void wait_for_beats(int beats) {
  bool before = carries(kHeartbeatLine);
  wait_until("the heartbeat", [&] {
    const bool now = carries(kHeartbeatLine);
    beats -= now != before ? 1 : 0;
    before = now;
    return beats <= 0;
  });
}

void press(Line button) {
  // The debounce, and some cycles that the heartbeat may not be seen in.
  constexpr int kSettled = 8;
  pull(button, true);
  wait_for_beats(kSettled);
  pull(button, false);
  wait_for_beats(kSettled);
}

}  // namespace hotfire::test
