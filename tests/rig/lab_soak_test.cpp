// SPDX-License-Identifier: Apache-2.0
// Plant, controller and lab as programs on the virtual rig, for a given time, with everything that goes wrong going wrong at
// random and together: frames lost, doubled and late, a queue that stands, bus-off, bus down, stop and enable lines, second
// senders, stopped and killed processes, a disk that stalls, buttons that bounce. HOTFIRE_SOAK_SECONDS, HOTFIRE_SOAK_SEED.
#include <CppUTest/TestHarness.h>
#include <net/if.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "firmware/interlock/faults.hpp"
#include "tests/rig/lab_bench.hpp"
#include "tests/rig/lab_laws.hpp"
#include "tests/rig/lab_stops.hpp"

namespace hotfire::test {
namespace {

using Clock = std::chrono::steady_clock;
using firmware::Fault;

constexpr const char* kDisk = "/disk";
constexpr const char* kRecording = "/disk/lab.hfr";
constexpr int kControllerCycles = 20;      ///< of a second controller, each with a command
constexpr double kHighestPosition = 0.06;  ///< of the usual image [m]

double number_of(const char* name, double otherwise) {
  const char* text = std::getenv(name);
  return text == nullptr || *text == '\0' ? otherwise : std::strtod(text, nullptr);
}

/// What goes wrong for a while, in one of several places; of one place one thing at a time.
struct Trouble {
  enum Place : std::uint8_t { kBus, kStop, kHydraulic, kPlant, kLab, kDiskPlace, kPlaces };
  Place place;
  const char* name;
  void (*begin)(pid_t plant, pid_t lab);
  void (*end)(pid_t plant, pid_t lab);
};

void netem(const char* what) { shell(std::string("tc qdisc add dev can0 root netem ") + what); }
void no_netem(pid_t, pid_t) { shell("tc qdisc del dev can0 root 2>/dev/null; true"); }

constexpr std::array<Trouble, 10> kTroubles{{
    {Trouble::kBus, "frames lost", [](pid_t, pid_t) { netem("loss 20%"); }, no_netem},
    {Trouble::kBus, "frames doubled", [](pid_t, pid_t) { netem("duplicate 20%"); }, no_netem},
    {Trouble::kBus, "frames late", [](pid_t, pid_t) { netem("delay 20ms 20ms"); }, no_netem},
    {Trouble::kBus, "queue stands", [](pid_t, pid_t) { netem("delay 100s limit 1"); }, no_netem},
    {Trouble::kBus, "bus down", [](pid_t, pid_t) { shell("ip link set can0 down"); },
     [](pid_t, pid_t) { shell("ip link set can0 up"); }},
    {Trouble::kStop, "emergency stop", [](pid_t, pid_t) { pull(kStopLine, false); },
     [](pid_t, pid_t) { pull(kStopLine, true); }},
    {Trouble::kHydraulic, "no hydraulics", [](pid_t, pid_t) { pull(kHydraulicLine, false); },
     [](pid_t, pid_t) { pull(kHydraulicLine, true); }},
    {Trouble::kPlant, "plant stopped", [](pid_t plant, pid_t) { kill(plant, SIGSTOP); },
     [](pid_t plant, pid_t) { kill(plant, SIGCONT); }},
    {Trouble::kLab, "lab stopped", [](pid_t, pid_t lab) { kill(lab, SIGSTOP); },
     [](pid_t, pid_t lab) { kill(lab, SIGCONT); }},
    {Trouble::kDiskPlace, "disk stalled", [](pid_t, pid_t) { shell(std::string("fsfreeze --freeze ") + kDisk); },
     [](pid_t, pid_t) { shell(std::string("fsfreeze --unfreeze ") + kDisk); }},
}};

}  // namespace

TEST_GROUP(LabSoak) {
  std::mt19937_64 random{static_cast<std::uint64_t>(number_of("HOTFIRE_SOAK_SEED", 1))};
  std::unique_ptr<SensorNode> listener;
  std::unique_ptr<LabProgram> lab;
  pid_t plant = -1;
  pid_t controller = -1;
  std::array<const Trouble*, Trouble::kPlaces> now{};
  std::map<std::string, int> happened;
  std::uint64_t injected = 0;  ///< commands that the lab did not send
  std::uint64_t cycles = 0;
  std::uint64_t drove = 0;
  std::uint64_t profiles = 0;

  void setup() override {
    shell("ip link add dev can0 type vcan; ip link set can0 up");
    bank_up();
    shell(std::string("mkdir -p ") + kDisk + "; mke2fs -q -F -t ext2 /dev/ram0; mount -t ext4 /dev/ram0 " + kDisk);
    listener = std::make_unique<SensorNode>();
    listener->mode = SensorNode::Mode::silent;
    shell("rig_plant_image >/tmp/plant.image");
    start_plant();
  }
  void teardown() override {
    all_well_again();
    lab.reset();
    for (const pid_t process : {controller, plant}) {
      if (process > 0) {
        kill(process, SIGKILL);
        waitpid(process, nullptr, 0);
      }
    }
    listener.reset();
    shell(std::string("umount ") + kDisk);
    bank_down();
  }

  bool chance(std::uint64_t one_in) { return random() % one_in == 0; }
  std::uint64_t between(std::uint64_t least, std::uint64_t most) { return least + random() % (most - least + 1); }
  void pass_ms(std::uint64_t time) const { usleep(static_cast<useconds_t>(1000 * time)); }

  static pid_t start(const std::string& command) {
    const pid_t process = fork();
    if (process == 0) {
      execl("/bin/sh", "sh", "-c", ("exec " + command).c_str(), nullptr);
      _exit(127);
    }
    return process;
  }

  void start_plant() {
    shell("rm -f /tmp/plant.hfr");
    const auto is_recording = [] { return access("/tmp/plant.hfr", R_OK) == 0; };
    const auto is_gone = [&] { return waitpid(plant, nullptr, WNOHANG) == plant; };
    do {
      // A lab that gives the bus up takes it down, at any time: then the plant is refused and started again.
      raise_bus();
      plant = start(
          "hotfire-rt plant --image /tmp/plant.image --bus can0 --sync can --sync-patience-ms 200 "
          "--max-missed-syncs 1000000 --period-us 10000 --warm-up 0 --record /tmp/plant.hfr >/tmp/plant.out 2>&1");
      bool gone = false;
      wait_until("the plant's recording", [&] { return is_recording() || (gone = is_gone()); });
      if (gone) {
        plant = -1;
      }
    } while (plant < 0);
    wait_until("the plant's socket for SYNC",
               [] { return std::system("grep -q '^ *can0 *080 ' /proc/net/can/rcvlist_sff") == 0; });
  }

  /// Every cycle is computed again to the same bits. After a cycle that a stalled disk has cost the state is not known, so a
  /// replay ends there and says so.
  static void replay(const std::string& recording, const std::string& output) {
    shell("hotfire-rt replay " + recording +
          " >/tmp/replay; grep -qE 'every recorded cycle has the same bits|which was dropped' /tmp/replay || { cat "
          "/tmp/replay " +
          output + "; false; }");
  }

  /// Ends the plant: what it recorded is computed again to the same bits.
  void end_plant(int signal) {
    kill(plant, SIGCONT);
    kill(plant, signal);
    waitpid(plant, nullptr, 0);
    plant = -1;
    replay("/tmp/plant.hfr", "/tmp/plant.out");
    ++happened[signal == SIGKILL ? "plant killed" : "plant ended"];
  }

  void end(const Trouble*& trouble) {
    if (trouble != nullptr) {
      trouble->end(plant, lab ? lab->process() : -1);
      trouble = nullptr;
    }
  }
  void all_well_again() {
    for (const Trouble*& trouble : now) {
      end(trouble);
    }
    raise_bus();
  }

  /// What a lab that has given the bus up leaves to a person.
  static void raise_bus() { shell("ip link set can0 up"); }

  void something_happens() {
    const Trouble& trouble = kTroubles[random() % kTroubles.size()];
    const Trouble*& there = now[trouble.place];
    if (there != nullptr) {
      end(there);
    } else if (chance(2)) {
      there = &trouble;
      ++happened[trouble.name];
      trouble.begin(plant, lab->process());
    }
    // At once, without a length of its own.
    switch (random() % 12) {
      case 0:
        happened["bus-off"] += listener->report_bus_off() ? 1 : 0;
        break;
      case 1:
        listener->send_command();
        ++injected;
        ++happened["a command of another sender"];
        break;
      case 2:
        if (now[Trouble::kPlant] == nullptr && now[Trouble::kBus] == nullptr) {
          end_plant(chance(2) ? SIGKILL : SIGTERM);
          start_plant();
        }
        break;
      case 3:
        if (controller < 0 && now[Trouble::kBus] == nullptr) {
          // What it sends is not to be told from the lab's, but by the lab.
          controller = start("hotfire-rt controller --bus can0 --period-us 10000 --cycles " +
                             std::to_string(kControllerCycles) + " --warm-up 0 >/tmp/controller.out 2>&1");
          injected += kControllerCycles;
          ++happened["a second controller"];
        }
        break;
      default:
        if (now[Trouble::kBus] == nullptr) {
          raise_bus();
        }
        break;
    }
    if (controller > 0 && waitpid(controller, nullptr, WNOHANG) == controller) {
      controller = -1;
    }
  }

  /// How many different faults were the first one of a run.
  std::ptrdiff_t faults() const {
    return std::ranges::count_if(happened, [](const auto& one) { return one.first.starts_with("first fault"); });
  }

  void print_account(std::uint64_t runs, double seconds) const {
    std::printf("%.0f s: %llu runs of the lab, %llu cycles, %llu of them drove, %llu profiles started\n", seconds,
                static_cast<unsigned long long>(runs), static_cast<unsigned long long>(cycles),
                static_cast<unsigned long long>(drove), static_cast<unsigned long long>(profiles));
    std::fflush(stdout);
  }

  /// A press as contacts give it: on and off for some milliseconds, then on, and the same at its end.
  void press_with_bounce(Line button) {
    for (const bool on : {true, false}) {
      for (std::uint64_t bounces = random() % 3; bounces > 0; --bounces) {
        pull(button, on);
        pull(button, !on);
      }
      pull(button, on);
      pass_ms(between(50, 150));
    }
  }

  /// A run of the lab from its start to its end, however it ends.
  void run_a_lab() {
    // A plant that has lost its bus does not come back by itself.
    end_plant(SIGTERM);
    start_plant();
    lab = std::make_unique<LabProgram>("segment.0.duration 4\nlimits.reading_age 0.4\nlimits.command_age 0.4\n",
                                       std::string("--record-buffer-s 2 --record ") + kRecording);
    const bool alone = chance(4);  // nothing goes wrong: the profile runs to its end
    for (std::uint64_t steps = between(20, 60); steps > 0; --steps) {
      if (!alone && chance(5)) {
        something_happens();
      }
      if (chance(3)) {
        press_with_bounce(carries(kSupplyLine) && !chance(5) ? kStartLine : kArmLine);
      }
      pass_ms(between(10, 200));
    }
    const bool killed = chance(6);
    if (killed) {
      lab->signal(SIGKILL);
    } else {
      lab->signal(chance(2) ? SIGTERM : SIGHUP);
    }
    pass_ms(between(0, 300));
    all_well_again();
    const int status = lab->wait();
    ++happened[killed ? "lab killed" : "lab ended"];
    if (!killed) {
      // Run to its end, asked to stop, a frame still before the bus, or a fault: never anything else.
      CHECK(status == 0 || status == 1 || status == 3 || status == 5);
      CHECK(!carries(kSupplyLine));
    }
    look_at_recording(!killed);
    lab.reset();
  }

  void look_at_recording(bool ended) {
    replay(kRecording, "/tmp/lab.out");
    const LawsOfARecording laws = laws_of(kRecording, kHighestPosition, ended);
    STRCMP_EQUAL("", laws.broken.c_str());
    cycles += laws.cycles;
    drove += laws.drove;
    profiles += laws.running;
    for (const Stop& stop : read_lab_record(kRecording, {400'000'000, 500}).stops) {
      ++happened[std::string("first fault: ") + std::string(firmware::text_of(stop.fault).name)];
    }
    CHECK(listener->commands_when_not_driving <= injected);
  }
};

TEST(LabSoak, WhateverGoesWrongTogetherEveryCycleKeepsTheLaws) {
  const double seconds = number_of("HOTFIRE_SOAK_SECONDS", 20.0);
  const Clock::time_point begun = Clock::now();
  std::uint64_t runs = 0;
  double reported = 0.0;
  const auto passed = [&] { return std::chrono::duration<double>(Clock::now() - begun).count(); };
  // On a slow machine little happens in a short time.
  constexpr double kMostExtraSeconds = 100.0;
  while (passed() < seconds || ((drove == 0 || faults() == 0) && passed() < seconds + kMostExtraSeconds)) {
    run_a_lab();
    ++runs;
    // A long soak that its host ends has said how far it came.
    constexpr double kReportEverySeconds = 300.0;
    if (passed() > reported + kReportEverySeconds) {
      reported = passed();
      print_account(runs, reported);
    }
  }
  end_plant(SIGTERM);
  print_account(runs, passed());
  for (const auto& [what, count] : happened) {
    std::printf("  %-40s %d\n", what.c_str(), count);
  }
  // Else too little happened for the laws to mean anything.
  CHECK(drove > 0);
  CHECK(faults() > 0);
  CHECK(seconds < 600.0 || (faults() >= 8 && profiles >= 20));
}

}  // namespace hotfire::test
