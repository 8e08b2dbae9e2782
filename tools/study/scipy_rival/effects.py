# SPDX-License-Identifier: Apache-2.0
"""The candidates that the comparison knows: the laws of docs/physics.md, section 5, with their model's keys.

A field is (name, start, lower bound); its value is p["EFFECT.NAME"]. With a lower bound above zero it is searched in
logarithms. Starts are the typical values that the finder starts from as well.
"""


class NoEffect:
    """The declared model."""

    name, law, fields, small = "", "", (), ()

    def opening(self, p, at, spool):
        return spool

    def spring(self, p, at, deflection):
        return p["stiffness"] * deflection

    def torque(self, p, at, angle, rate, own):
        return (0.0,)


class GimbalFriction(NoEffect):
    """LuGre without bristle damping: z' = w - sigma0 |w| z / g(w), T = sigma0 z."""

    name, law, small = "gimbal_friction", "lugre", (1e-5,)
    fields = (
        ("coulomb_torque", 8e3, 1.0),
        ("stiffness", 1e7, 1e4),
        ("static_ratio", 1.2, 1.0),
        ("stribeck_velocity", 0.01, 1e-6),
    )

    def torque(self, p, at, angle, rate, own):
        (bristle,) = own
        relative = rate / p["gimbal_friction.stribeck_velocity"]
        more = (p["gimbal_friction.static_ratio"] - 1.0) * at.exp(-relative * relative)
        level = p["gimbal_friction.coulomb_torque"] * (1.0 + more)
        torque = p["gimbal_friction.stiffness"] * bristle
        return torque, rate - abs(rate) * torque / level


class SoftStiffness(NoEffect):
    """Actuator that is softer below a load, in series with the load stiffness."""

    name, law = "soft_stiffness", "compliance"
    fields = (("low_stiffness", 4e7, 1e5), ("load_scale", 8e3, 10.0))

    def spring(self, p, at, deflection):
        actuator, load, scale = p["actuator.stiffness"], p["structure.stiffness"], p["soft_stiffness.load_scale"]
        further = 1.0 / p["soft_stiffness.low_stiffness"] - 1.0 / actuator
        distance = abs(deflection)
        # The deflection is concave in the force: from the tangent at zero Newton's method comes from below.
        force = distance / (1.0 / actuator + 1.0 / load + further)
        for _ in range(4):
            fading = at.exp(-force / scale)
            error = force / actuator + force / load + further * scale * (1.0 - fading) - distance
            force = force - error / (1.0 / actuator + 1.0 / load + further * fading)
        return at.sign(deflection) * force


class ValveDeadband(NoEffect):
    """No flow within the spool's lap."""

    name, law = "valve_deadband", ""
    fields = (("half_width", 0.02, 1e-6),)

    def opening(self, p, at, spool):
        return spool - at.lower(at.upper(spool, p["valve_deadband.half_width"]), -p["valve_deadband.half_width"])


class DuctHardening(NoEffect):
    """Torque with the angle to the third power."""

    name, law = "duct_hardening", ""
    fields = (("cubic", 1e7, -1e10),)

    def torque(self, p, at, angle, rate, own):
        return (p["duct_hardening.cubic"] * angle * angle * angle,)


KNOWN = {effect.name: effect for effect in (GimbalFriction(), SoftStiffness(), ValveDeadband(), DuctHardening())}
