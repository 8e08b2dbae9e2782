// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "model/effects/actuator/leakage.hpp"
#include "model/effects/actuator/piston_friction.hpp"
#include "model/effects/command/command_delay.hpp"
#include "model/effects/command/command_scale.hpp"
#include "model/effects/command/drive_deadband.hpp"
#include "model/effects/command/drive_saturation.hpp"
#include "model/effects/command/rate_limit.hpp"
#include "model/effects/gimbal/cross_axis.hpp"
#include "model/effects/gimbal/duct_hardening.hpp"
#include "model/effects/gimbal/gimbal_compliance.hpp"
#include "model/effects/gimbal/gimbal_friction.hpp"
#include "model/effects/gimbal/torque_offset.hpp"
#include "model/effects/load/backlash.hpp"
#include "model/effects/load/soft_stiffness.hpp"
#include "model/effects/load/structural_mode.hpp"
#include "model/effects/load/variable_moment_arm.hpp"
#include "model/effects/mass/cubic_stiffness.hpp"
#include "model/effects/mass/elastic_stop.hpp"
#include "model/effects/mass/force_offset.hpp"
#include "model/effects/mass/free_play.hpp"
#include "model/effects/mass/position_damping.hpp"
#include "model/effects/mass/quadratic_damping.hpp"
#include "model/effects/mass/quadratic_stiffness.hpp"
#include "model/effects/mass/sliding_friction.hpp"
#include "model/effects/sensor/sensor_delay.hpp"
#include "model/effects/sensor/sensor_lag.hpp"
#include "model/effects/sensor/sensor_nonlinearity.hpp"
#include "model/effects/sensor/sensor_scale.hpp"
#include "model/effects/unlisted/term.hpp"
#include "model/effects/unlisted/unlisted_cross_torque.hpp"
#include "model/effects/unlisted/unlisted_deflection.hpp"
#include "model/effects/unlisted/unlisted_motion.hpp"
#include "model/effects/unlisted/unlisted_oil.hpp"
#include "model/effects/unlisted/unlisted_reading.hpp"
#include "model/effects/unlisted/unlisted_ripple.hpp"
#include "model/effects/unlisted/unlisted_signal.hpp"
#include "model/effects/unlisted/unlisted_wiper_play.hpp"
#include "model/effects/valve/valve_asymmetry.hpp"
#include "model/effects/valve/valve_bias.hpp"
#include "model/effects/valve/valve_deadband.hpp"
#include "model/effects/valve/valve_hysteresis.hpp"

namespace hotfire::model {

/// Every effect of a hydraulic axis. At serial sites the order is the order of application: along the signal path for
/// command and valve; at the load spring geometry first, then play, then the spring itself.
using SimplexEffects =
    EffectList<CommandScale, RateLimit, CommandDelay, UnlistedSignal<Site::command>, Term<Site::command>,
               UnlistedSignal<Site::valve_command>, Term<Site::valve_command>, ValveBias, ValveHysteresis, UnlistedOpening,
               Term<Site::valve>, ValveDeadband, ValveAsymmetry, Leakage, UnlistedFlow, Term<Site::flow>, UnlistedPressure,
               PistonFriction, UnlistedMotion<Site::piston>, Term<Site::piston>, UnlistedDeflection, Term<Site::load_spring>,
               VariableMomentArm, Backlash, SoftStiffness, StructuralMode, GimbalFriction, GimbalCompliance, DuctHardening,
               TorqueOffset, CrossAxis, UnlistedMotion<Site::engine_torque>, Term<Site::engine_torque>, UnlistedCrossTorque,
               SensorNonlinearity, UnlistedWiperPlay, UnlistedReading, UnlistedDrift, UnlistedRipple, Term<Site::sensor, 0>,
               Term<Site::sensor, 1>, SensorLag, SensorDelay, SensorScale>;

/// Every effect of an axis of a `Masv`, in the same order. Effects that the vehicle itself contains are left out: geometry,
/// modes and the friction of its bearings. The delays of command and sensors are left out too: their memory of 24 KiB an
/// axis would be most of the state of eight. A `Taos` has the whole list.
using MasvEffects =
    EffectList<RateLimit, ValveBias, ValveHysteresis, ValveDeadband, ValveAsymmetry, Leakage, PistonFriction, Backlash,
               SoftStiffness, DuctHardening, TorqueOffset, CrossAxis, SensorNonlinearity, SensorLag>;

/// Every effect of a body that is moved along a path. A constant force is the zero of the sensor that reads the force.
using ImposedMotionEffects = EffectList<SlidingFriction, QuadraticStiffness, CubicStiffness, ElasticStop, FreePlay,
                                        PositionDamping, QuadraticDamping, UnlistedMotion<Site::mass_force>>;

/// Every effect of the joint of a structure in modal coordinates.
using JointEffects = EffectList<SlidingFriction, ForceOffset, QuadraticStiffness, CubicStiffness, ElasticStop,
                                PositionDamping, QuadraticDamping, UnlistedMotion<Site::mass_force>>;

/// Every effect of a mass that a force drives: those of its drive, in the order of application, and those of the body.
using DirectEffects =
    EffectList<DriveSaturation, CommandDelay, DriveDeadband, SlidingFriction, ForceOffset, QuadraticStiffness,
               CubicStiffness, FreePlay, PositionDamping, QuadraticDamping, UnlistedMotion<Site::mass_force>>;

/// Every effect of an electromechanical actuator: along its signal path, of its motor, of its transmission, of its load.
using ElectromechanicalEffects =
    EffectList<CommandScale, CommandDelay, DriveDeadbandAt<Site::drive>, DriveSaturationAt<Site::drive>, MotorFriction,
               BacklashAt<Site::transmission>, SlidingFriction, ForceOffset, QuadraticStiffness, CubicStiffness, ElasticStop,
               PositionDamping, QuadraticDamping, UnlistedMotion<Site::mass_force>>;

}  // namespace hotfire::model
