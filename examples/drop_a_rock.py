"""Drop the paper's rock on its plate under two laws, and compare what was asked with what came out."""

import vibroimpact as vi

case = {
    "sphere": {"radius": "25 mm", "material": "rock-paper"},
    "plate": {"material": "steel-paper"},
    "drop": {"height": "4 m", "gravity": 9.8},
    "contact": {"law": "lankarani-nikravesh", "restitution": 0.65},
    "run": {"impacts": 3},
}
response = vi.simulate(vi.read_case(case))

print(response.status)
print("asked   ", response.impacts["restitution_asked"])
print("achieved", response.impacts["restitution_achieved"].round(6))
print("largest force [N]", response.impacts["max_force_N"].round(1))

# a recorder of 20 kHz would see about five samples of each contact
signal = response.sample(20e3)
print("largest sampled force [N]", signal["force_N"].max().round(1))
