// SPDX-License-Identifier: Apache-2.0
// Two nodes that send one message, frames that are damaged or lost, and commands that nobody answers: in every layout, of
// every message that a lab with a limit of load pressure listens to.

#include <memory>

#include "tests/firmware/lab/lab_on_wire.hpp"

namespace hotfire::firmware {

namespace {

using test_lab::kPeriodNs;
using test_lab::LabOnWire;

constexpr double kTrue = 0.14;       ///< where the piston is: beyond its limit of 0.06 m
constexpr double kPretended = 0.01;  ///< what the other node says

/// Of a lab: the shortest, the longest, and others.
constexpr std::array<std::int64_t, 6> kPeriodsNs{250'000, 500'000, 1'000'000, 2'000'000, 5'000'000, 10'000'000};

/// How often a node sends each of its messages: so many frames in every so many cycles.
struct Rate {
  int frames = 1;
  int cycles = 1;
  bool answers_sync = false;
};

/// A lab of as many actuators as a layout has room for, with a period of its own.
LabSettings settings_of(can::Layout frames, std::int64_t period_ns, const Rate& declared) {
  LabSettings made = test_lab::full_settings(frames);
  made.profile = Profile({test_lab::segment(100.0, 0.02, 0.02)});
  made.limits.command_age_ns = 5 * period_ns;
  made.limits.actuators.fill({5 * declared.cycles * period_ns, -0.06, 0.06, 100.0, 2e7});
  // One frame a cycle need not be declared.
  made.limits.reading_period_ns = declared.frames == declared.cycles ? 0 : declared.cycles * period_ns / declared.frames;
  made.limits.readings_answer_sync = declared.answers_sync;
  return made;
}

/// A lab that runs in a layout, and another node, which may send what its plant and itself send.
class Rivals : public LabOnWire {
 public:
  static constexpr std::size_t kNone = 99;  ///< of the messages

  explicit Rivals(can::Layout frames) : LabOnWire(test_lab::full_settings(frames), frames) { run(); }

  /// With a plant that sends at a rate, which may be another one than was declared.
  Rivals(can::Layout frames, std::int64_t cycle_ns, const Rate& rate, const Rate& declared)
      : LabOnWire(settings_of(frames, cycle_ns, declared), frames, usual_lines(), cycle_ns) {
    sends = false;
    before_lab = [this, rate, cycle = 0]() mutable {
      for (int i = 0; i < rate.frames && cycle % rate.cycles == 0; ++i) {
        send_every_message();
      }
      ++cycle;
    };
    cycles(rate.cycles);  // until a frame has come after time 0, which is none
    run();
  }

  /// From now on the other node sends this message as often as the plant, with counters that fit.
  void double_message(std::size_t which) { doubled_ = which; }

  void other_sends(const hal::CanFrame& frame) {
    other_.receive(clock.now_ns());
    CHECK(other_.try_send(frame) == hal::CanSend::taken);
    other_.receive(clock.now_ns());
  }

  std::size_t messages() const { return rig.messages(); }
  bool drives() const { return lab.outputs().interlock.drive; }
  const FaultSet& faults() const { return lab.outputs().interlock.faults; }

 private:
  std::vector<hal::CanId> all_ids() const {
    std::vector<hal::CanId> ids = can::plant_ids(layout, actuators, {.load_pressure = true}).senders;
    for (const hal::CanId& id : can::controller_ids(layout, actuators).senders) {
      ids.push_back(id);
    }
    return ids;
  }

  void send_every_message() {
    for (std::size_t which = 0; which < messages(); ++which) {
      CHECK(plant.try_send(reading(which, next_[which]++)) == hal::CanSend::taken);
      plant.receive(clock.now_ns());
      if (which == doubled_) {
        other_sends(reading(which, next_[which]++));
      }
    }
  }

  Wire::Node other_{wire, {}, all_ids()};
  std::size_t doubled_ = kNone;
  std::array<std::uint8_t, can::kMostReadingMessages + 1> next_{};  ///< counter of the next frame of each message
};

/// Runs `act(layout, which, period_ns)` for every message of every layout that a lab listens to, at every period.
template <class Act>
void at_every_period(Act&& act) {
  for (const std::int64_t period_ns : kPeriodsNs) {
    for (std::size_t layout = 0; layout < can::kLayouts.size(); ++layout) {
      const auto frames = static_cast<can::Layout>(layout);
      const std::size_t messages = can::reading_messages(frames, can::most_actuators(frames)) + 1;
      for (std::size_t which = 0; which < messages; ++which) {
        act(frames, which, period_ns);
      }
    }
  }
}

/// Runs `act(rivals, which)` on a lab of its own for every message of every layout that it listens to.
template <class Act>
void for_every_message(Act&& act) {
  for (std::size_t layout = 0; layout < can::kLayouts.size(); ++layout) {
    const auto frames = static_cast<can::Layout>(layout);
    const std::size_t messages = Rivals(frames).messages();
    for (std::size_t which = 0; which < messages; ++which) {
      Rivals rivals(frames);
      act(rivals, which);
    }
  }
}

/// The piston is beyond its limit, and after every true frame another node says that it is not, `ahead` of its counter.
/// Two cycles at most until nothing is driven.
void expect_found_out(Rivals& rivals, std::size_t which, std::uint8_t ahead) {
  rivals.piston = kTrue;
  rivals.before_lab = [&] {
    const auto sent = static_cast<std::uint8_t>(rivals.counter - 1);
    for (std::size_t i = 0; i < rivals.messages(); ++i) {
      rivals.piston = i == which ? kPretended : kTrue;
      rivals.other_sends(rivals.reading(i, static_cast<std::uint8_t>(sent + ahead)));
    }
    rivals.piston = kTrue;
  };
  rivals.cycles(2);
  CHECK(!rivals.drives());
  CHECK(!rivals.on(kSupply));
  CHECK(rivals.faults().has(Fault::second_sender));
}

/// After one cycle nothing is driven, first because of this fault.
void expect_stopped_in_a_cycle(Rivals& rivals, Fault fault) {
  rivals.cycle();
  CHECK(!rivals.drives());
  CHECK(rivals.lab.outputs().interlock.first == fault);
}

}  // namespace

TEST_GROUP(SecondSender){};

TEST(SecondSender, HealthyRigOfAnyLayoutHasNoFaultWhileCountersGoRound) {
  for_every_message([](Rivals& rivals, std::size_t) {
    rivals.cycles(600);
    CHECK(rivals.drives());
  });
}

TEST(SecondSender, FramesThatWereHeldUpAndComeAtOnceAreNoFault) {
  for_every_message([](Rivals& rivals, std::size_t which) {
    for (int again = 0; again < 20; ++again) {
      constexpr std::uint8_t kHeldUp = 4;
      rivals.sends = false;
      rivals.cycles(kHeldUp);
      rivals.before_lab = [&] {
        for (std::uint8_t late = 0; late <= kHeldUp; ++late) {
          for (std::size_t i = 0; i < rivals.messages(); ++i) {
            rivals.plant.try_send(rivals.reading(i, static_cast<std::uint8_t>(rivals.counter - kHeldUp - 1 + late)));
            rivals.plant.receive(0);
          }
        }
      };
      rivals.cycle();
      rivals.before_lab = [] {};
      rivals.sends = true;
      rivals.cycles(6);
    }
    CHECK(which < rivals.messages() && rivals.drives());
  });
}

TEST(SecondSender, TwoFramesWithOneCounterAreFoundOut) {
  for_every_message([](Rivals& rivals, std::size_t which) { expect_found_out(rivals, which, 0); });
}

TEST(SecondSender, TwoFramesOfOneMessageAloneAreFoundOutInTheirCycle) {
  for_every_message([](Rivals& rivals, std::size_t which) {
    rivals.before_lab = [&] { rivals.other_sends(rivals.reading(which, static_cast<std::uint8_t>(rivals.counter - 1))); };
    rivals.cycle();
    CHECK(!rivals.drives());
    CHECK(rivals.faults() == FaultSet(Fault::second_sender));
    UNSIGNED_LONGS_EQUAL(1, rivals.rig.readings(which).repeated);
  });
}

TEST(SecondSender, CounterThatGoesBackIsFoundOut) {
  for_every_message([](Rivals& rivals, std::size_t which) { expect_found_out(rivals, which, 255); });
}

TEST(SecondSender, CounterOfAnotherSeriesIsFoundOut) {
  for_every_message([](Rivals& rivals, std::size_t which) { expect_found_out(rivals, which, 90); });
}

TEST(SecondSender, CounterThatRunsAheadOfTheTrueOneIsFoundOut) {
  for_every_message([](Rivals& rivals, std::size_t which) { expect_found_out(rivals, which, 1); });
}

TEST(SecondSender, MoreFramesThanAreDueAreFoundOutInTwoCyclesAtEveryPeriodThoughTheirCountersFit) {
  at_every_period([](can::Layout layout, std::size_t which, std::int64_t period_ns) {
    Rivals rivals(layout, period_ns, {}, {});
    rivals.cycles(300);
    CHECK(rivals.drives());
    rivals.double_message(which);
    rivals.cycles(2);
    CHECK(!rivals.drives());
    CHECK(!rivals.on(kSupply));
    CHECK(rivals.faults() == FaultSet(Fault::second_sender));
    UNSIGNED_LONGS_EQUAL(1, rivals.rig.readings(which).too_many);
  });
}

TEST(SecondSender, NodeThatDoesNotSendOnceAPeriodIsDeclaredAndHeldToThatAtEveryPeriod) {
  for (const Rate& rate : {Rate{4, 1}, Rate{1, 4}, Rate{3, 2}}) {
    at_every_period([&rate](can::Layout layout, std::size_t which, std::int64_t period_ns) {
      Rivals rivals(layout, period_ns, rate, rate);
      rivals.cycles(300);
      CHECK(rivals.drives());
      rivals.double_message(which);
      rivals.cycles(2 * rate.cycles);
      CHECK(!rivals.drives());
      CHECK(rivals.faults() == FaultSet(Fault::second_sender));
    });
  }
}

TEST(SecondSender, NodesThatAnswerSyncAreHeldToOneFrameForEachHoweverLateTheCyclesAre) {
  at_every_period([](can::Layout layout, std::size_t which, std::int64_t period_ns) {
    Rivals rivals(layout, period_ns, {}, {.answers_sync = true});
    rivals.after_cycle = [&] { rivals.clock.advance_ns(2 * period_ns); };
    rivals.cycles(300);
    CHECK(rivals.drives());
    rivals.double_message(which);
    rivals.cycles(2);
    CHECK(!rivals.drives());
    CHECK(rivals.faults() == FaultSet(Fault::second_sender));
  });
}

TEST(SecondSender, CommandThatTheLabDidNotSendIsFoundOut) {
  for_every_message([](Rivals& rivals, std::size_t) {
    const can::Message& message = can::command_message(rivals.layout);
    const std::array<double, hal::kMaxActuators> currents{};
    hal::CanFrame frame;
    CHECK(can::encode(message, std::span(currents).first(message.signals.size()), 7, frame));
    rivals.before_lab = [&] { rivals.other_sends(frame); };
    expect_stopped_in_a_cycle(rivals, Fault::second_sender);
  });
}

TEST(SecondSender, DamagedFrameIsABadFrameThoughAGoodOneFollowsIt) {
  for_every_message([](Rivals& rivals, std::size_t which) {
    rivals.before_lab = [&] {
      hal::CanFrame damaged = rivals.reading(which, static_cast<std::uint8_t>(rivals.counter - 1));
      damaged.data[5] ^= 1;
      rivals.other_sends(damaged);
      for (std::size_t i = 0; i < rivals.messages(); ++i) {
        rivals.other_sends(rivals.reading(i, rivals.counter));
      }
      ++rivals.counter;
    };
    expect_stopped_in_a_cycle(rivals, Fault::bad_frame);
    UNSIGNED_LONGS_EQUAL(1, rivals.rig.readings(which).refused);
  });
}

TEST(SecondSender, LostFrameIsABadFrameThoughAnotherOneWasOvertaken) {
  for_every_message([](Rivals& rivals, std::size_t which) {
    rivals.before_lab = [&] {
      // One frame more of every message, of which that of `which` leaves a counter out.
      for (std::size_t i = 0; i < rivals.messages(); ++i) {
        const unsigned gap = i == which ? 1 : 0;
        rivals.other_sends(rivals.reading(i, static_cast<std::uint8_t>(rivals.counter + gap)));
      }
    };
    expect_stopped_in_a_cycle(rivals, Fault::bad_frame);
    UNSIGNED_LONGS_EQUAL(1, rivals.rig.readings(which).skipped);
  });
}

TEST(SecondSender, FrameOfTheOtherFormatIsABadFrame) {
  for_every_message([](Rivals& rivals, std::size_t which) {
    hal::CanFrame frame = rivals.reading(which, rivals.counter);
    frame.fd = !frame.fd;
    rivals.before_lab = [&] { rivals.other_sends(frame); };
    expect_stopped_in_a_cycle(rivals, Fault::bad_frame);
  });
}

TEST(SecondSender, MoreFramesThanCanBeLookedAtAreABadFrame) {
  for_every_message([](Rivals& rivals, std::size_t which) {
    rivals.before_lab = [&] {
      for (std::size_t i = 0; i <= LabOnWire::Wire::kMaxFrames; ++i) {
        rivals.other_sends(rivals.reading(which, rivals.counter));
      }
    };
    rivals.cycle();
    CHECK(!rivals.drives());
    CHECK(rivals.faults().has(Fault::bad_frame));
    CHECK(rivals.node.counters().dropped > 0);
  });
}

TEST_GROUP(CommandEcho){};

TEST(CommandEcho, NodeThatDoesNotHearCommandsIsFoundOutAfterTheirAgeLimit) {
  for_every_message([](Rivals& rivals, std::size_t) {
    rivals.hears_commands = false;
    const auto limit = static_cast<int>(rivals.lab.limits().command_age_ns / kPeriodNs);
    rivals.cycles(limit);
    CHECK(rivals.drives());
    rivals.cycles(2);
    CHECK_EQUAL(!can::has_echo(rivals.layout), rivals.drives());
    CHECK(!can::has_echo(rivals.layout) || rivals.lab.outputs().interlock.first == Fault::command_not_answered);
  });
}

TEST(CommandEcho, EchoOfACounterThatDoesNotMoveIsNoAnswerThoughItComesRoundAgain) {
  can::CommandEcho echo(1);
  for (unsigned cycle = 0; cycle < 1000; ++cycle) {
    echo.note_sent(static_cast<std::uint8_t>(cycle), cycle);
    echo.note_echo(0, 5);
  }
  CHECK(echo.age_ns(1000) >= 990);
}

TEST(CommandEcho, OldestNodeCounts) {
  can::CommandEcho echo(2);
  for (unsigned cycle = 0; cycle < 10; ++cycle) {
    echo.note_sent(static_cast<std::uint8_t>(cycle), cycle);
    echo.note_echo(0, static_cast<std::uint8_t>(cycle));
    echo.note_echo(1, static_cast<std::uint8_t>(cycle / 2));
  }
  LONGS_EQUAL(10 - 4, echo.age_ns(10));
  echo.forget();
  LONGS_EQUAL(0, echo.age_ns(10));
}

TEST_GROUP(SplitReadings){};

TEST(SplitReadings, NodeOfOneReadingThatFallsSilentIsStaleAndOneThatSaysSomethingElseDisagrees) {
  for (const can::Layout layout : {can::Layout::classic_split, can::Layout::fd_split}) {
    for (std::size_t quiet = 0; quiet < can::reading_messages(layout, can::most_actuators(layout)); ++quiet) {
      Rivals silent(layout);
      silent.sends = false;
      silent.before_lab = [&] {
        for (std::size_t i = 0; i < silent.messages(); ++i) {
          if (i != quiet) {
            silent.plant.try_send(silent.reading(i, static_cast<std::uint8_t>(silent.counter - 1)));
          }
        }
      };
      silent.cycles(7);
      CHECK(!silent.drives());
      CHECK(silent.faults().has(Fault::stale_sensor));
    }

    Rivals wrong(layout);
    wrong.sends = false;
    wrong.before_lab = [&] {
      for (std::size_t i = 0; i < wrong.messages(); ++i) {
        wrong.piston = i % 2 == 0 ? 0.0 : 0.002;
        wrong.plant.try_send(wrong.reading(i, static_cast<std::uint8_t>(wrong.counter - 1)));
      }
    };
    wrong.cycle();
    CHECK(wrong.lab.outputs().interlock.first == Fault::readings_disagree);
  }
}

}  // namespace hotfire::firmware
