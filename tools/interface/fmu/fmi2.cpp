// SPDX-License-Identifier: Apache-2.0
#include <exception>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "tools/interface/fmu/export_names.hpp"
#include "tools/interface/fmu/fmi2_types.hpp"
#include "tools/interface/fmu/message.hpp"
#include "tools/interface/fmu/saved_block.hpp"
#include "tools/interface/fmu/slave.hpp"

// The functions of FMI 2.0 for co-simulation. What modelDescription.xml does not offer returns fmi2Error.

namespace {

using hotfire::fmu::Message;
using hotfire::fmu::Slave;
using hotfire::fmu::Status;

constexpr std::string_view kDoubled = "#%";

struct Component {
  std::string name;
  fmi2CallbackFunctions callbacks;
  std::unique_ptr<Slave> slave;
};

fmi2Status said(Status status) { return static_cast<fmi2Status>(status); }

/// The status of a call of an instance's slave. A missing instance is an error that has no one to log it.
template <class Call>
fmi2Status with_slave(fmi2Component component, Call&& call) {
  return component == nullptr ? fmi2Error : said(call(*static_cast<Component*>(component)->slave));
}

void deliver(void* instance, Status status, const char* category, const char* message) {
  const auto& own = *static_cast<Component*>(instance);
  if (own.callbacks.logger != nullptr) {
    own.callbacks.logger(own.callbacks.componentEnvironment, own.name.c_str(), said(status), category,
                         Message(message, kDoubled).c_str());
  }
}

fmi2Status refuse(fmi2Component component, Status status, const char* function, const char* problem) {
  return with_slave(component, [&](Slave& slave) { return slave.refuse(status, function, problem); });
}

fmi2Status unsupported(fmi2Component component, const char* function) {
  return refuse(component, Status::error, function, "is not supported; see the capabilities in modelDescription.xml");
}

/// Variables of another type than Real: the FMU has none.
fmi2Status none(fmi2Component component, const char* function, std::size_t count) {
  return count == 0 && component != nullptr
             ? fmi2OK
             : refuse(component, Status::error, function, "the FMU has no variable of this type");
}

}  // namespace

// NOLINTBEGIN(readability-identifier-naming): the names are the standard's.

HOTFIRE_FMU_API const char* FMI2(fmi2GetTypesPlatform)() { return "default"; }
HOTFIRE_FMU_API const char* FMI2(fmi2GetVersion)() { return "2.0"; }

HOTFIRE_FMU_API fmi2Status FMI2(fmi2SetDebugLogging)(fmi2Component component, fmi2Boolean on, std::size_t count,
                                                     const fmi2String categories[]) {
  return with_slave(component, [&](Slave& slave) { return slave.set_logging(on != 0, {categories, count}); });
}

HOTFIRE_FMU_API fmi2Component FMI2(fmi2Instantiate)(fmi2String name, fmi2Type type, fmi2String guid, fmi2String resources,
                                                    const fmi2CallbackFunctions* callbacks, fmi2Boolean,
                                                    fmi2Boolean logging) {
  if (callbacks == nullptr) {
    return nullptr;
  }
  std::unique_ptr<Component> component;
  std::string message;
  try {
    component = std::make_unique<Component>(Component{name != nullptr ? name : "", *callbacks, nullptr});
    if (component->name.find_first_not_of(" \t\r\n") == std::string::npos) {
      message = "the name of the instance is empty; allowed: at least one character that is not a space";
    } else if (type != fmi2CoSimulation) {
      message = "the FMU is for co-simulation only; allowed: fmi2CoSimulation";
    } else {
      const std::string text = hotfire::fmu::plant_document(
          hotfire::fmu::kCompiledPlant != nullptr ? "" : hotfire::fmu::path_of_uri(resources != nullptr ? resources : ""));
      component->slave = Slave::open(text, guid, &deliver, component.get(), message);
    }
  } catch (const std::exception& error) {
    message = error.what();
  }
  if (component == nullptr || component->slave == nullptr) {
    if (callbacks->logger != nullptr) {
      callbacks->logger(callbacks->componentEnvironment, name != nullptr ? name : "", fmi2Error,
                        hotfire::fmu::kCategories[0], Message("fmi2Instantiate: " + message, kDoubled).c_str());
    }
    return nullptr;
  }
  component->slave->set_logging(logging != 0, {});
  return component.release();
}

HOTFIRE_FMU_API void FMI2(fmi2FreeInstance)(fmi2Component component) { delete static_cast<Component*>(component); }

HOTFIRE_FMU_API fmi2Status FMI2(fmi2SetupExperiment)(fmi2Component component, fmi2Boolean, fmi2Real, fmi2Real start,
                                                     fmi2Boolean stop_defined, fmi2Real stop) {
  return with_slave(component, [&](Slave& slave) { return slave.set_up(start, stop_defined != 0, stop); });
}

HOTFIRE_FMU_API fmi2Status FMI2(fmi2EnterInitializationMode)(fmi2Component component) {
  return with_slave(component, [&](Slave& slave) { return slave.enter_initialization(); });
}
HOTFIRE_FMU_API fmi2Status FMI2(fmi2ExitInitializationMode)(fmi2Component component) {
  return with_slave(component, [&](Slave& slave) { return slave.exit_initialization(); });
}
HOTFIRE_FMU_API fmi2Status FMI2(fmi2Terminate)(fmi2Component component) {
  return with_slave(component, [&](Slave& slave) { return slave.terminate(); });
}
HOTFIRE_FMU_API fmi2Status FMI2(fmi2Reset)(fmi2Component component) {
  return with_slave(component, [&](Slave& slave) { return slave.reset(); });
}

HOTFIRE_FMU_API fmi2Status FMI2(fmi2GetReal)(fmi2Component component, const fmi2ValueReference references[],
                                             std::size_t count, fmi2Real values[]) {
  return with_slave(component, [&](Slave& slave) { return slave.get({references, count}, {values, count}); });
}
HOTFIRE_FMU_API fmi2Status FMI2(fmi2SetReal)(fmi2Component component, const fmi2ValueReference references[],
                                             std::size_t count, const fmi2Real values[]) {
  return with_slave(component, [&](Slave& slave) { return slave.set({references, count}, {values, count}); });
}
HOTFIRE_FMU_API fmi2Status FMI2(fmi2GetInteger)(fmi2Component component, const fmi2ValueReference[], std::size_t count,
                                                fmi2Integer[]) {
  return none(component, "fmi2GetInteger", count);
}
HOTFIRE_FMU_API fmi2Status FMI2(fmi2SetInteger)(fmi2Component component, const fmi2ValueReference[], std::size_t count,
                                                const fmi2Integer[]) {
  return none(component, "fmi2SetInteger", count);
}
HOTFIRE_FMU_API fmi2Status FMI2(fmi2GetBoolean)(fmi2Component component, const fmi2ValueReference[], std::size_t count,
                                                fmi2Boolean[]) {
  return none(component, "fmi2GetBoolean", count);
}
HOTFIRE_FMU_API fmi2Status FMI2(fmi2SetBoolean)(fmi2Component component, const fmi2ValueReference[], std::size_t count,
                                                const fmi2Boolean[]) {
  return none(component, "fmi2SetBoolean", count);
}
HOTFIRE_FMU_API fmi2Status FMI2(fmi2GetString)(fmi2Component component, const fmi2ValueReference[], std::size_t count,
                                               fmi2String[]) {
  return none(component, "fmi2GetString", count);
}
HOTFIRE_FMU_API fmi2Status FMI2(fmi2SetString)(fmi2Component component, const fmi2ValueReference[], std::size_t count,
                                               const fmi2String[]) {
  return none(component, "fmi2SetString", count);
}

HOTFIRE_FMU_API fmi2Status FMI2(fmi2GetFMUstate)(fmi2Component component, fmi2FMUstate* state) {
  return with_slave(component, [&](Slave& slave) { return hotfire::fmu::get_state(slave, state); });
}
HOTFIRE_FMU_API fmi2Status FMI2(fmi2SetFMUstate)(fmi2Component component, fmi2FMUstate state) {
  return with_slave(component, [&](Slave& slave) { return hotfire::fmu::set_state(slave, state); });
}
HOTFIRE_FMU_API fmi2Status FMI2(fmi2FreeFMUstate)(fmi2Component, fmi2FMUstate* state) {
  hotfire::fmu::free_state(state);
  return fmi2OK;
}
HOTFIRE_FMU_API fmi2Status FMI2(fmi2SerializedFMUstateSize)(fmi2Component component, fmi2FMUstate state, std::size_t* size) {
  return with_slave(component, [&](Slave& slave) { return hotfire::fmu::state_size(slave, state, size); });
}
HOTFIRE_FMU_API fmi2Status FMI2(fmi2SerializeFMUstate)(fmi2Component component, fmi2FMUstate state, fmi2Byte bytes[],
                                                       std::size_t size) {
  return with_slave(component, [&](Slave& slave) { return hotfire::fmu::serialize(slave, state, bytes, size); });
}
HOTFIRE_FMU_API fmi2Status FMI2(fmi2DeSerializeFMUstate)(fmi2Component component, const fmi2Byte bytes[], std::size_t size,
                                                         fmi2FMUstate* state) {
  return with_slave(component, [&](Slave& slave) { return hotfire::fmu::deserialize(slave, bytes, size, state); });
}

HOTFIRE_FMU_API fmi2Status FMI2(fmi2GetDirectionalDerivative)(fmi2Component component, const fmi2ValueReference unknowns[],
                                                              std::size_t unknown_count, const fmi2ValueReference knowns[],
                                                              std::size_t known_count, const fmi2Real seed[],
                                                              fmi2Real sensitivity[]) {
  return with_slave(component, [&](Slave& slave) {
    return slave.differentiate({unknowns, unknown_count}, {knowns, known_count}, {seed, known_count},
                               {sensitivity, unknown_count});
  });
}

HOTFIRE_FMU_API fmi2Status FMI2(fmi2SetRealInputDerivatives)(fmi2Component component, const fmi2ValueReference[],
                                                             std::size_t, const fmi2Integer[], const fmi2Real[]) {
  return unsupported(component, "fmi2SetRealInputDerivatives");
}
HOTFIRE_FMU_API fmi2Status FMI2(fmi2GetRealOutputDerivatives)(fmi2Component component, const fmi2ValueReference[],
                                                              std::size_t, const fmi2Integer[], fmi2Real[]) {
  return unsupported(component, "fmi2GetRealOutputDerivatives");
}

HOTFIRE_FMU_API fmi2Status FMI2(fmi2DoStep)(fmi2Component component, fmi2Real current, fmi2Real step, fmi2Boolean) {
  return with_slave(component, [&](Slave& slave) { return slave.do_step(current, step); });
}
HOTFIRE_FMU_API fmi2Status FMI2(fmi2CancelStep)(fmi2Component component) { return unsupported(component, "fmi2CancelStep"); }

// A step is never pending, so that there is no status of one.
HOTFIRE_FMU_API fmi2Status FMI2(fmi2GetStatus)(fmi2Component component, const fmi2StatusKind, fmi2Status*) {
  return refuse(component, Status::discard, "fmi2GetStatus", "no step is pending");
}
HOTFIRE_FMU_API fmi2Status FMI2(fmi2GetRealStatus)(fmi2Component component, const fmi2StatusKind kind, fmi2Real* value) {
  if (kind != fmi2LastSuccessfulTime) {
    return refuse(component, Status::discard, "fmi2GetRealStatus", "allowed: fmi2LastSuccessfulTime");
  }
  if (value == nullptr) {
    return refuse(component, Status::error, "fmi2GetRealStatus", "a place for the value is missing");
  }
  return with_slave(component, [value](Slave& slave) {
    *value = slave.last_successful_time();
    return Status::ok;
  });
}
HOTFIRE_FMU_API fmi2Status FMI2(fmi2GetIntegerStatus)(fmi2Component component, const fmi2StatusKind, fmi2Integer*) {
  return refuse(component, Status::discard, "fmi2GetIntegerStatus", "there is no such status");
}
HOTFIRE_FMU_API fmi2Status FMI2(fmi2GetBooleanStatus)(fmi2Component component, const fmi2StatusKind kind,
                                                      fmi2Boolean* value) {
  if (kind != fmi2Terminated) {
    return refuse(component, Status::discard, "fmi2GetBooleanStatus", "allowed: fmi2Terminated");
  }
  if (value == nullptr) {
    return refuse(component, Status::error, "fmi2GetBooleanStatus", "a place for the value is missing");
  }
  return with_slave(component, [value](Slave&) {
    *value = 0;
    return Status::ok;
  });
}
HOTFIRE_FMU_API fmi2Status FMI2(fmi2GetStringStatus)(fmi2Component component, const fmi2StatusKind, fmi2String*) {
  return refuse(component, Status::discard, "fmi2GetStringStatus", "no step is pending");
}

// NOLINTEND(readability-identifier-naming)
