// SPDX-License-Identifier: Apache-2.0
#include "tests/doctor/patient.hpp"

namespace hotfire::doctor {

using test::expect_good;
using test::expect_remedy;

namespace {

/// What `ip -details -statistics -json link show dev can0` of iproute2 6.1 prints, shortened.
const std::string kHealthy = R"([{"ifindex":3,"ifname":"can0","flags":["NOARP","UP","LOWER_UP","ECHO"],"mtu":16,
  "qdisc":"pfifo_fast","operstate":"UP","txqlen":10,"link_type":"can","linkinfo":{"info_kind":"can","info_data":{
  "state":"ERROR-ACTIVE","berr_counter":{"tx":0,"rx":0},"restart_ms":0,"bittiming":{"bitrate":1000000,"sample_point":"0.750"},
  "clock":8000000},"info_xstats":{"restarts":0,"bus_error":0,"bus_off":0}}}])";

std::string changed(const std::string& before, const std::string& after) {
  std::string text = kHealthy;
  return text.replace(text.find(before), before.size(), after);
}

}  // namespace

TEST_GROUP(DoctorCan) {
  test::PatientFiles files;
  Patient patient = files.patient();

  void setup() override {
    files.put("sys/class/net/can0/type", "280");
    files.put("sys/class/net/eth0/type", "1");
    say(kHealthy);
  }

  void say(const std::string& text) { files.said["ip -details -statistics -json link show dev can0"] = text; }
  Finding found(const char* check) const { return test::finding_of(look_at_can(patient), check); }
};

TEST(DoctorCan, HealthyInterfaceHasNothingButGoodFindings) {
  const std::vector<Finding> findings = look_at_can(patient);
  UNSIGNED_LONGS_EQUAL(6, findings.size());
  for (const Finding& finding : findings) {
    expect_good(finding);
  }
  STRCMP_EQUAL("1000000 bit/s", found("can0 bit rate").what.c_str());
}

TEST(DoctorCan, MachineWithoutCanIsShownHowToTry) {
  std::filesystem::remove_all(patient.root / "sys/class/net/can0");
  expect_remedy(found("CAN"), Level::advice, "no CAN interface", "modprobe vcan");
}

TEST(DoctorCan, InterfaceThatIsAskedForAndNotThereIsBadAndTheOthersAreNamed) {
  patient.can = {"can7"};
  expect_remedy(found("can7"), Level::bad, "no such CAN interface; there are can0", "ip link show type can");
  patient.can = {"eth0"};
  expect_remedy(found("eth0"), Level::bad, "no such CAN interface", "ip link");
}

TEST(DoctorCan, InterfaceThatIsDownIsBad) {
  say(changed("\"UP\",\"LOWER_UP\",", ""));
  expect_remedy(found("can0 link"), Level::bad, "down", "ip link set can0 up");
}

TEST(DoctorCan, BitRateThatIsNotSetIsBad) {
  say(changed("\"bitrate\":1000000", "\"bitrate\":0"));
  expect_remedy(found("can0 bit rate"), Level::bad, "not set", "ip link set can0 type can bitrate 1000000 up");
}

TEST(DoctorCan, RestartByItselfIsBadBecauseItSendsWithoutAPerson) {
  say(changed("\"restart_ms\":0", "\"restart_ms\":100"));
  expect_remedy(found("can0 restart"), Level::bad, "100 ms after bus-off", "restart-ms 0");
}

TEST(DoctorCan, StateOfTheControllerIsJudged) {
  say(changed("ERROR-ACTIVE", "BUS-OFF"));
  expect_remedy(found("can0 state"), Level::bad, "bus-off", "ip link set can0 type can restart");
  say(changed("ERROR-ACTIVE", "ERROR-PASSIVE"));
  expect_remedy(found("can0 state"), Level::advice, "ERROR-PASSIVE", "termination");
}

TEST(DoctorCan, CountedErrorsAreToBeConsidered) {
  say(changed("\"tx\":0,\"rx\":0", "\"tx\":8,\"rx\":3"));
  expect_remedy(found("can0 errors"), Level::advice, "transmit 8, receive 3; bus-off 0 times", "-statistics link show can0");
  say(changed("\"bus_off\":0", "\"bus_off\":2"));
  expect_remedy(found("can0 errors"), Level::advice, "bus-off 2 times", "wiring");
}

TEST(DoctorCan, QueueThatReordersIsBadAndALongOneIsToBeConsidered) {
  say(changed("pfifo_fast", "fq_codel"));
  expect_remedy(found("can0 queue"), Level::bad, "fq_codel", "tc qdisc replace dev can0 root pfifo_head_drop");
  say(changed("\"txqlen\":10", "\"txqlen\":1000"));
  expect_remedy(found("can0 queue"), Level::advice, "1000 frames long", "txqueuelen 10");
}

TEST(DoctorCan, InterfaceThatOnlyListensOrTalksToItselfIsBad) {
  say(changed("\"restart_ms\"", "\"ctrlmode\":[\"LISTEN-ONLY\"],\"restart_ms\""));
  expect_remedy(found("can0 mode"), Level::bad, "LISTEN-ONLY", "listen-only off");
  say(changed("\"restart_ms\"", "\"ctrlmode\":[\"LOOPBACK\"],\"restart_ms\""));
  expect_remedy(found("can0 mode"), Level::bad, "LOOPBACK", "loopback off");
}

TEST(DoctorCan, VirtualBusIsSaidToFitAnySchedule) {
  say(R"([{"ifname":"can0","flags":["NOARP","UP"],"qdisc":"noqueue","txqlen":1000,"linkinfo":{"info_kind":"vcan"}}])");
  expect_remedy(found("can0 bit rate"), Level::advice, "virtual", "hotfire check");
}

TEST(DoctorCan, MachineWithoutIpIsAdvisedToInstallIt) {
  say("");
  expect_remedy(found("can0"), Level::advice, "reported nothing", "apt install iproute2");
  say("Object \"link\" is unknown");
  expect_remedy(found("can0"), Level::advice, "reported nothing", "iproute2");
}

}  // namespace hotfire::doctor
