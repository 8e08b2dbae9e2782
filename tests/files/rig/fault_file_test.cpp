// SPDX-License-Identifier: Apache-2.0
#include "tools/files/rig/fault_file.hpp"

#include "tests/files/expect.hpp"
#include "tests/files/scratch.hpp"

namespace hotfire {

using test::refusal;

TEST_GROUP(FaultFile) {
  test::Scratch scratch;
  ModelFile model;

  void setup() override { model.parameters = SimplexParameters{}; }

  std::string lines(const std::string& text) const {
    return load_faults(scratch.write("faults.toml", text), faulty_plant(model));
  }

  void refused(const std::string& fault, std::initializer_list<const char*> parts) const {
    const std::string text = "schema = 1\n[[fault]]\n" + fault;
    test::expect_message(refusal([&] { lines(text); }), parts);
  }
};

TEST(FaultFile, FaultsBecomeLinesOfAnImageInSi) {
  const std::string text = lines(
      "schema = 1\n[[fault]]\nkind = \"biased\"\nchannel = \"piston\"\nactuator = 2\nfrom = 2\nto = \"3500 ms\"\n"
      "value = \"-2 mm\"\n[[fault]]\nkind = \"bus_off\"\nfrom = 0.5\n[[fault]]\nkind = \"lost_supply\"\nfrom = 0\n"
      "value = 1048576\n");
  test::expect_message(text, {"fault.0.kind biased\nfault.0.from 0x1p+1\nfault.0.to 0x1.cp+1\nfault.0.actuator 2\n",
                              "fault.0.channel piston\nfault.0.value -0x1.0624dd2f1a9fcp-9\n",
                              "fault.1.kind bus_off\nfault.1.from 0x1p-1\nfault.1.to inf\nfault.2.kind lost_supply\n",
                              "fault.2.actuator 0\nfault.2.value 0x1p+20\n"});
}

TEST(FaultFile, WhatCannotBeIsRefusedWithItsLineAndWhatIsAllowed) {
  refused("kind = \"biassed\"\n", {"faults.toml:3", "fault.0.kind", "did you mean \"biased\"?"});
  refused("from = 1\n", {"faults.toml:2", "fault.0.kind: missing; allowed: stuck, biased"});
  refused("kind = \"stuck\"\nfrom = 1\n", {"fault.0.channel: missing; allowed: piston, engine, load_pressure"});
  refused("kind = \"stuck\"\nfrom = -1\nchannel = \"piston\"\n", {"faults.toml:4", "fault.0.from", "allowed: 0 to"});
  refused("kind = \"stuck\"\nfrom = 2\nto = 1\nchannel = \"piston\"\n", {"faults.toml:5", "fault.0.to", "allowed: 2 to"});
  refused("kind = \"stuck\"\nfrom = 1\nchannel = \"pistn\"\n", {"fault.0.channel", "did you mean \"piston\"?"});
  refused("kind = \"stuck\"\nfrom = 1\nchannel = \"piston\"\nactuator = 9\n", {"fault.0.actuator", "1 to 8"});
  refused("kind = \"stuck\"\nfrom = 1\nchannel = \"piston\"\nvalue = 9\n", {"faults.toml:6", "value"});
  refused("kind = \"biased\"\nfrom = 1\nchannel = \"piston\"\nvalue = \"2 kg\"\n", {"faults.toml:6", "fault.0.value", "m"});
  refused("kind = \"delayed\"\nfrom = 1\nchannel = \"piston\"\nvalue = \"2 s\"\n", {"fault.0.value", "allowed: 0 to 1 s"});
  refused("kind = \"bus_off\"\nfrom = 1\nactuator = 1\n", {"faults.toml:5", "actuator"});
  refused("kind = \"torque\"\nfrom = 1\nvalue = \"2 kN\"\n", {"faults.toml:5", "fault.0.value", "N.m"});
  refused("kind = \"thrust\"\nfrom = 1\nvalue = 0\n", {"faults.toml:3", "needs a gimbal bearing", "taos"});
}

TEST(FaultFile, FileWithoutSchemaOrFaultIsRefused) {
  test::expect_message(refusal([&] { lines("[[fault]]\nkind = \"bus_off\"\nfrom = 1\n"); }), {"schema: missing"});
  test::expect_message(refusal([&] { lines("schema = 1\n"); }), {"fault: missing; declare at least one"});
  test::expect_message(refusal([&] { lines("schema = 1\nfault = 3\n"); }), {"fault: missing"});
}

TEST(FaultFile, HydraulicFaultOfAModelWithoutHydraulicsIsRefused) {
  model.parameters = DirectParameters{};
  refused("kind = \"leak\"\nfrom = 1\nvalue = 1e-9\n", {"faults.toml:3", "fault.0.kind", "hydraulic axis"});
}

}  // namespace hotfire
