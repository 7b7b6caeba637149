# %% [markdown]
# # The drive, tick by tick
# The library's own code: the bits of the firmware, in `f32` and in fixed point.

# %%
import numpy as np

import driveline

roll = driveline.Machine.example("roll")
inertia = sum(roll.design()["inertias"])

# %% [markdown]
# A motor that is accelerated by 50 N m, as an encoder and a current control would report it.

# %%
single, fixed = roll.drive("f32"), roll.drive("fixed")
time = np.arange(5_000) / single.rate_hz
angle = 0.5 * 50.0 / inertia * time**2
for drive in (single, fixed):
    course = drive.run(angle, 50.0, 0.0)
    print(f"{drive.name}: {course['motor_speed'][-1]:.3f} rad/s, command {course['torque'][-1]:.1f} N m")
print(f"expected {50.0 / inertia * time[-1]:.3f} rad/s")

# %% [markdown]
# Words instead of SI units: what the firmware's link carries. `driveline.variants()` has all scenes of the firmware.

# %%
print(len(driveline.variants()), "variants")
drive = driveline.Drive.variant("hoist/fixed/reduced/10000")
print(drive.exchange(np.zeros((3, 8), dtype=np.uint32))[-1])
