# %% [markdown]
# # A loop to look at
# A machine, its vibrations, and the speed loop that is designed for it.

# %%
import numpy as np

import driveline

hoist = driveline.Machine.example("hoist")
modes = hoist.modes()
print(sorted(modes))

# %%
design = hoist.design()
loop = design["speed_loop"]
print(f"{loop['observer']}, {loop['bandwidth'] / (2 * np.pi):.2f} Hz wide")
print(f"margins: {20 * np.log10(loop['margins']['gain_up']):.1f} dB, {np.degrees(loop['margins']['phase']):.0f} degrees")

# %% [markdown]
# The open loop over frequency; `design.frequency_response()` hands it to python-control, `design.plot()` draws it.

# %%
responses = design["responses"]
gain = responses["nominal"]["open"]["gain"]
print(f"gain 1 at {responses['hz'][np.flatnonzero(gain > 1)[-1]]:.2f} Hz")

# %% [markdown]
# A softer rope: a changed file is a machine, too.

# %%
softer = driveline.Machine.of_text(hoist.text.replace("2.9e6", "1.5e6"))
print(f"{softer.design()['shaft']['resonance'] / (2 * np.pi):.2f} Hz")
