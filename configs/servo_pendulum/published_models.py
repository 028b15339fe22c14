#!/usr/bin/env python3
"""Free runs of the published friction models of this servo on the recordings of this folder, for comparison.

Equations: docs/theory/models.rst of github Rhoban/bam (Apache-2.0), commit 1b5a1ce: friction at rest takes what stops the motor within one step, up to
its limit; one step of semi-implicit Euler per fifth of a sampling interval. Parameters: bam/params/xl330/m1.json ... m6.json there. Written anew from the
equations; misfit itself does not use it.
"""
import csv
import math
import pathlib

MASS, LENGTH, GRAVITY = 0.49, 0.1, 9.80665
MODELS = {
    "M1 Coulomb": dict(kt=0.3866957639, R=4.0171292223, armature=0.0018141673, q_offset=0.0308710003, base=0.0128327204, viscous=0.0036616723),
    "M2 Stribeck": dict(kt=0.3852809157, R=4.0002638870, armature=0.0018192853, q_offset=0.0328454803, base=0.0, stribeck=0.0126512383,
                        dtheta=4.1665211110, alpha=1.3636445350, viscous=0.0056208455),
    "M3 load": dict(kt=0.3804202284, R=3.3800669548, armature=0.0019177723, q_offset=0.0294395769, base=0.0088817130, viscous=0.0043790998,
                    load=(0.1216645553, 0.1216645553)),
    "M4 load, Stribeck": dict(kt=0.3861709980, R=3.4025726412, armature=0.0018954553, q_offset=0.0280724588, base=0.0087586276, stribeck=0.0,
                              load=(0.0680335733, 0.0680335733), load_stribeck=(0.0738118083, 0.0738118083), dtheta=2.5577016869,
                              alpha=0.7601158769, viscous=0.0046210350),
    "M5 directional": dict(kt=0.3622127815, R=2.7519133088, armature=0.0018468936, q_offset=0.0291423706, base=0.0003659521, stribeck=0.0086778876,
                           load=(0.2896521958, 0.0), load_stribeck=(3.0574e-05, 0.0586825054), dtheta=3.1889119964, alpha=2.9904004892,
                           viscous=0.0063480319),
    "M6 quadratic": dict(kt=0.3660134968, R=2.8113923539, armature=0.0018077433, q_offset=0.0271132870, base=0.0047711832, stribeck=0.0046763458,
                         load=(0.2667860954, 8.5e-06), load_stribeck=(1.0723e-05, 0.0807892898), quad=(0.0099724712, 0.0049025657),
                         dtheta=2.8903720941, alpha=8.6832599076, viscous=0.0053596683),
}


def friction(p, motor, external, speed):
    """Limit of the friction at rest [N m], of the motor's and of the external torque."""
    through_gears = lambda factors: abs(external * factors[1] - motor * factors[0])
    slow = math.exp(-(abs(speed / p["dtheta"]) ** p["alpha"])) if "dtheta" in p else 0.0
    limit = p["base"] + through_gears(p.get("load", (0, 0)))
    limit += slow * (p.get("stribeck", 0.0) + through_gears(p.get("load_stribeck", (0, 0))))
    if "quad" in p and external * motor < 0:
        limit += slow * (p["quad"][1] * external**2 if abs(external) < abs(motor) else p["quad"][0] * motor**2)
    return limit


def free_run(p, rows):
    inertia = p["armature"] + MASS * LENGTH**2
    angle, speed = rows[0]["angle"], rows[0]["speed"]
    out, parts = [angle], 5
    for row, after in zip(rows, rows[1:]):
        dt = (after["t"] - row["t"]) / parts
        for k in range(parts):
            goal = row["goal"] + (after["goal"] - row["goal"]) * k / parts
            duty = max(-1.0, min(1.0, row["gain"] * 4096 / (2 * math.pi) / 885 * (goal - angle)))
            motor = p["kt"] / p["R"] * (duty * row["supply"] - p["kt"] * speed) if row["powered"] else 0.0
            external = -MASS * GRAVITY * LENGTH * math.sin(angle + p["q_offset"])
            net = motor + external
            stop = inertia / dt * speed + net
            net -= math.copysign(min(abs(stop), friction(p, motor, external, speed) + p["viscous"] * abs(speed)), stop)
            angle += speed * dt + 0.5 * net / inertia * dt**2
            speed += net / inertia * dt
        out.append(angle)
    return out


def read(path):
    with open(path, newline="") as file:
        return [{name.split("[")[0]: float(value) for name, value in row.items()} for row in csv.DictReader(file)]


if __name__ == "__main__":
    folder = pathlib.Path(__file__).parent
    print("RMS error of the angle of free runs [deg]")
    for name, p in MODELS.items():
        line = f"{name:18}"
        for gain in ("kp100", "kp400"):
            squares = samples = 0
            for motion in ("lift_and_drop", "sin_sin", "sin_time_square", "up_and_down"):
                rows = read(folder / f"{gain}_{motion}.csv")
                errors = [(row["angle"] - angle) ** 2 for row, angle in zip(rows, free_run(p, rows))]
                squares, samples = squares + sum(errors), samples + len(errors)
            line += f"  {gain}: {math.degrees(math.sqrt(squares / samples)):.2f}"
        print(line)
