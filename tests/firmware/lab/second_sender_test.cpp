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

/// A lab that runs in a layout, and another node, which may send what its plant and itself send.
class Rivals : public LabOnWire {
 public:
  explicit Rivals(can::Layout frames) : LabOnWire(test_lab::full_settings(frames), frames) { run(); }

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

  Wire::Node other_{wire, {}, all_ids()};
};

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

TEST(SecondSender, MoreFramesThanAreDueAreFoundOutThoughTheirCountersFit) {
  for_every_message([](Rivals& rivals, std::size_t which) {
    rivals.before_lab = [&] {
      for (std::size_t i = 0; i < rivals.messages(); ++i) {
        rivals.other_sends(rivals.reading(i, rivals.counter));
      }
      ++rivals.counter;
    };
    rivals.cycles(20);
    CHECK(!rivals.drives());
    CHECK(rivals.lab.outputs().interlock.first == Fault::second_sender);
    CHECK(rivals.rig.readings(which).too_many > 0);
  });
}

TEST(SecondSender, CommandThatTheLabDidNotSendIsFoundOut) {
  for_every_message([](Rivals& rivals, std::size_t) {
    const can::Message& message = can::command_message(rivals.layout);
    const std::array<double, hal::kMaxActuators> currents{};
    hal::CanFrame frame;
    CHECK(can::encode(message, std::span(currents).first(message.signals.size()), 7, frame));
    rivals.before_lab = [&] { rivals.other_sends(frame); };
    rivals.cycle();
    CHECK(!rivals.drives());
    CHECK(rivals.lab.outputs().interlock.first == Fault::second_sender);
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
    rivals.cycle();
    CHECK(!rivals.drives());
    CHECK(rivals.lab.outputs().interlock.first == Fault::bad_frame);
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
    rivals.cycle();
    CHECK(!rivals.drives());
    CHECK(rivals.lab.outputs().interlock.first == Fault::bad_frame);
    UNSIGNED_LONGS_EQUAL(1, rivals.rig.readings(which).skipped);
  });
}

TEST(SecondSender, FrameOfTheOtherFormatIsABadFrame) {
  for_every_message([](Rivals& rivals, std::size_t which) {
    hal::CanFrame frame = rivals.reading(which, rivals.counter);
    frame.fd = !frame.fd;
    rivals.before_lab = [&] { rivals.other_sends(frame); };
    rivals.cycle();
    CHECK(!rivals.drives());
    CHECK(rivals.lab.outputs().interlock.first == Fault::bad_frame);
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
