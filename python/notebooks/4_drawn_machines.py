# %% [markdown]
# # Machines drawn from within their tolerances

# %%
import tempfile
from pathlib import Path

import driveline

roll = driveline.Machine.example("roll")
two_masses = roll.campaign(draws=4, seed=1)
print(sorted(two_masses))

# %% [markdown]
# A run by the full solver, with the force of every link over time.

# %%
train = Path(tempfile.mkdtemp()) / "gear-pair.toml"
train.write_text(driveline.example("gear-pair"))
run = driveline.simulate(train)
print({name: values.shape for name, values in run["course"].items()})
print({link["name"]: round(link["greatest"], 1) for link in run["links"]})
