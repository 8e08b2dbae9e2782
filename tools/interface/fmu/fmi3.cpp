// SPDX-License-Identifier: Apache-2.0
#include <exception>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "tools/interface/fmu/export_names.hpp"
#include "tools/interface/fmu/fmi3_types.hpp"
#include "tools/interface/fmu/message.hpp"
#include "tools/interface/fmu/saved_block.hpp"
#include "tools/interface/fmu/slave.hpp"

// The functions of FMI 3.0 for co-simulation; fmi3_unsupported.cpp has those of the capabilities that the FMU does not have.

namespace {

using hotfire::fmu::Message;
using hotfire::fmu::Slave;
using hotfire::fmu::Status;

constexpr std::string_view kDoubled = "#";

struct Instance {
  fmi3InstanceEnvironment environment;
  fmi3LogMessageCallback log;
  std::unique_ptr<Slave> slave;
};

fmi3Status said(Status status) { return static_cast<fmi3Status>(status); }

/// The status of a call of an instance's slave. A missing instance is an error that has no one to log it.
template <class Call>
fmi3Status with_slave(fmi3Instance instance, Call&& call) {
  return instance == nullptr ? fmi3Error : said(call(*static_cast<Instance*>(instance)->slave));
}

void deliver(void* instance, Status status, const char* category, const char* message) {
  const auto& own = *static_cast<Instance*>(instance);
  if (own.log != nullptr) {
    own.log(own.environment, said(status), category, Message(message, kDoubled).c_str());
  }
}

}  // namespace

fmi3Status hotfire_fmi3_refuse(fmi3Instance instance, const char* function, const char* problem) {
  return with_slave(instance, [&](Slave& slave) { return slave.refuse(Status::error, function, problem); });
}

// NOLINTBEGIN(readability-identifier-naming): the names are the standard's.

HOTFIRE_FMU_API const char* FMI3(fmi3GetVersion)() { return "3.0"; }

HOTFIRE_FMU_API fmi3Status FMI3(fmi3SetDebugLogging)(fmi3Instance instance, fmi3Boolean on, std::size_t count,
                                                     const fmi3String categories[]) {
  return with_slave(instance, [&](Slave& slave) { return slave.set_logging(on, {categories, count}); });
}

HOTFIRE_FMU_API fmi3Instance FMI3(fmi3InstantiateCoSimulation)(
    fmi3String name, fmi3String token, fmi3String resources, fmi3Boolean, fmi3Boolean logging, fmi3Boolean event_mode,
    fmi3Boolean, const fmi3ValueReference[], std::size_t intermediate_variables, fmi3InstanceEnvironment environment,
    fmi3LogMessageCallback callback, fmi3IntermediateUpdateCallback) {
  std::unique_ptr<Instance> instance;
  std::string message;
  try {
    instance = std::make_unique<Instance>(Instance{environment, callback, nullptr});
    if (name == nullptr || std::string_view(name).find_first_not_of(" \t\r\n") == std::string_view::npos) {
      message = "the name of the instance is empty; allowed: at least one character that is not a space";
    } else if (event_mode) {
      message = "eventModeUsed: the FMU has no event mode; allowed: fmi3False";
    } else if (intermediate_variables > 0) {
      message = "requiredIntermediateVariables: the FMU provides none; allowed: none";
    } else {
      const std::string text = hotfire::fmu::plant_document(resources != nullptr ? resources : "");
      instance->slave = Slave::open(text, token, &deliver, instance.get(), message);
    }
  } catch (const std::exception& error) {
    message = error.what();
  }
  if (instance == nullptr || instance->slave == nullptr) {
    if (callback != nullptr) {
      callback(environment, fmi3Error, hotfire::fmu::kCategories[0],
               Message("fmi3InstantiateCoSimulation: " + message, kDoubled).c_str());
    }
    return nullptr;
  }
  instance->slave->set_logging(logging, {});
  return instance.release();
}

HOTFIRE_FMU_API void FMI3(fmi3FreeInstance)(fmi3Instance instance) { delete static_cast<Instance*>(instance); }

HOTFIRE_FMU_API fmi3Status FMI3(fmi3EnterInitializationMode)(fmi3Instance instance, fmi3Boolean, fmi3Float64,
                                                             fmi3Float64 start, fmi3Boolean stop_defined, fmi3Float64 stop) {
  return with_slave(instance, [&](Slave& slave) {
    const Status status = slave.set_up(start, stop_defined, stop);
    return status == Status::ok ? slave.enter_initialization() : status;
  });
}
HOTFIRE_FMU_API fmi3Status FMI3(fmi3ExitInitializationMode)(fmi3Instance instance) {
  return with_slave(instance, [&](Slave& slave) { return slave.exit_initialization(); });
}
HOTFIRE_FMU_API fmi3Status FMI3(fmi3Terminate)(fmi3Instance instance) {
  return with_slave(instance, [&](Slave& slave) { return slave.terminate(); });
}
HOTFIRE_FMU_API fmi3Status FMI3(fmi3Reset)(fmi3Instance instance) {
  return with_slave(instance, [&](Slave& slave) { return slave.reset(); });
}

HOTFIRE_FMU_API fmi3Status FMI3(fmi3GetFloat64)(fmi3Instance instance, const fmi3ValueReference references[],
                                                std::size_t count, fmi3Float64 values[], std::size_t value_count) {
  return with_slave(instance, [&](Slave& slave) { return slave.get({references, count}, {values, value_count}); });
}
HOTFIRE_FMU_API fmi3Status FMI3(fmi3SetFloat64)(fmi3Instance instance, const fmi3ValueReference references[],
                                                std::size_t count, const fmi3Float64 values[], std::size_t value_count) {
  return with_slave(instance, [&](Slave& slave) { return slave.set({references, count}, {values, value_count}); });
}

HOTFIRE_FMU_API fmi3Status FMI3(fmi3GetFMUState)(fmi3Instance instance, fmi3FMUState* state) {
  return with_slave(instance, [&](Slave& slave) { return hotfire::fmu::get_state(slave, state); });
}
HOTFIRE_FMU_API fmi3Status FMI3(fmi3SetFMUState)(fmi3Instance instance, fmi3FMUState state) {
  return with_slave(instance, [&](Slave& slave) { return hotfire::fmu::set_state(slave, state); });
}
HOTFIRE_FMU_API fmi3Status FMI3(fmi3FreeFMUState)(fmi3Instance, fmi3FMUState* state) {
  hotfire::fmu::free_state(state);
  return fmi3OK;
}
HOTFIRE_FMU_API fmi3Status FMI3(fmi3SerializedFMUStateSize)(fmi3Instance instance, fmi3FMUState state, std::size_t* size) {
  return with_slave(instance, [&](Slave& slave) { return hotfire::fmu::state_size(slave, state, size); });
}
HOTFIRE_FMU_API fmi3Status FMI3(fmi3SerializeFMUState)(fmi3Instance instance, fmi3FMUState state, fmi3Byte bytes[],
                                                       std::size_t size) {
  return with_slave(instance, [&](Slave& slave) { return hotfire::fmu::serialize(slave, state, bytes, size); });
}
HOTFIRE_FMU_API fmi3Status FMI3(fmi3DeserializeFMUState)(fmi3Instance instance, const fmi3Byte bytes[], std::size_t size,
                                                         fmi3FMUState* state) {
  return with_slave(instance, [&](Slave& slave) { return hotfire::fmu::deserialize(slave, bytes, size, state); });
}

HOTFIRE_FMU_API fmi3Status FMI3(fmi3GetDirectionalDerivative)(fmi3Instance instance, const fmi3ValueReference unknowns[],
                                                              std::size_t unknown_count, const fmi3ValueReference knowns[],
                                                              std::size_t known_count, const fmi3Float64 seed[],
                                                              std::size_t seed_count, fmi3Float64 sensitivity[],
                                                              std::size_t sensitivity_count) {
  return with_slave(instance, [&](Slave& slave) {
    return slave.differentiate({unknowns, unknown_count}, {knowns, known_count}, {seed, seed_count},
                               {sensitivity, sensitivity_count});
  });
}

HOTFIRE_FMU_API fmi3Status FMI3(fmi3DoStep)(fmi3Instance instance, fmi3Float64 current, fmi3Float64 step, fmi3Boolean,
                                            fmi3Boolean* event_handling_needed, fmi3Boolean* terminate, fmi3Boolean* early,
                                            fmi3Float64* last_successful) {
  return with_slave(instance, [&](Slave& slave) {
    if (event_handling_needed == nullptr || terminate == nullptr || early == nullptr || last_successful == nullptr) {
      return slave.refuse(Status::error, "fmi3DoStep", "a place for a result is missing");
    }
    *event_handling_needed = false;
    *terminate = false;
    *early = false;
    const Status status = slave.do_step(current, step);
    *last_successful = slave.last_successful_time();
    return status;
  });
}

// NOLINTEND(readability-identifier-naming)
