"""
Newton's cradle with Hertz contacts
===================================

One ball hits four that touch. If they collided in pairs, one after another, the last would leave
with the full speed and the others would stop. Hertz's contacts overlap in time, so that the last
ball has 98.9 % of the speed and the first rebounds; with gaps of a tenth of a millimetre the last
ball leaves with the full speed to 1e-5.
"""

# %%
# Five balls in a row
# -------------------
# A system has several bodies and contacts; contacts may be closed at the same time.
import matplotlib.pyplot as plt
import numpy as np

import vibroimpact as vi

law = vi.laws.Hertz(stiffness=1e9)  # N/m^1.5


def cradle(gap):
    """Return the response of five balls in a row, with gaps between them [m]; the first
    comes with 1 m/s.
    """
    balls = {
        f"ball {number}": vi.MovingBody(mass=0.1, velocity=(float(number == 1), 0.0, 0.0))
        for number in range(1, 6)
    }
    contacts = {
        f"{number} on {number + 1}": vi.PointContact(
            below=f"ball {number}",
            above=f"ball {number + 1}",
            law=law,
            gap=gap,
            normal=(1.0, 0.0, 0.0),
        )
        for number in range(1, 5)
    }
    return vi.simulate_system(vi.System(bodies=balls, contacts=contacts), duration=1.2e-3)


touching, apart = cradle(0.0), cradle(1e-4)


def speeds(response, time):
    """Return the speeds of the balls [m/s] at a time."""
    return np.array([float(ball.velocity[0]) for ball in response.at(time).values()])


# %%
# Momentum and energy are conserved; the first ball does not stop.
for response in (touching, apart):
    assert abs(speeds(response, 1.2e-3).sum() - 1.0) < 1e-9
    assert abs((speeds(response, 1.2e-3) ** 2).sum() - 1.0) < 1e-9
assert np.allclose(speeds(touching, 1.2e-3)[[0, -1]], [-0.071, 0.989], atol=5e-4)
assert np.allclose(speeds(apart, 1.2e-3), [0.0, 0.0, 0.0, 0.0, 1.0], atol=1e-5)

# %%
# Speeds over time
# ----------------
plt.style.use("vibroimpact.charts.print")
figure, panels = plt.subplots(2, figsize=(6.4, 5.0), sharex=True, sharey=True, layout="constrained")
time = np.linspace(0.0, 1.2e-3, 800)
colours = plt.get_cmap("cividis")(np.linspace(0.0, 0.9, 5))
for axes, response, words in zip(
    panels, (touching, apart), ("the balls touch", "gaps of 0.1 mm"), strict=True
):
    moving = np.array([speeds(response, one) for one in time])
    for number, colour in enumerate(colours):
        axes.plot(
            1e6 * time, moving[:, number], color=colour, linewidth=1.8, label=f"ball {number + 1}"
        )
    axes.set(ylabel="Speed [m/s]", title=f"Newton's cradle: {words}", xlim=(0.0, 1200.0))
    for number in (0, 4):
        axes.text(
            1205,
            moving[-1, number],
            f"{100.0 * moving[-1, number].round(4) + 0.0:.1f} %",
            color=colours[number],
            va="center",
            fontsize=8,
            clip_on=False,
        )
panels[0].legend(loc="center left", bbox_to_anchor=(0.62, 0.5))
panels[1].set_xlabel("Time since first touch [µs]")
plt.show()
