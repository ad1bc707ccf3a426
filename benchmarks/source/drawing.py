"""What the figures of the gallery share: colours, axes, and how a figure is written."""

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

RED, BLUE, ORANGE, GREY, BLACK = "#b2182b", "#2166ac", "#e08214", "#666666", "#222222"
plt.rcParams.update(
    {
        "font.size": 9,
        "axes.titlesize": 9,
        "axes.titlelocation": "left",
        "axes.spines.top": False,
        "axes.spines.right": False,
        "axes.grid": True,
        "grid.color": "#e4e4e4",
        "grid.linewidth": 0.6,
        "legend.frameon": False,
        "lines.linewidth": 1.3,
        "figure.constrained_layout.use": True,
    }
)


def save(figure, path):
    figure.savefig(path, dpi=110)
    plt.close(figure)


def mark(ax, x, y, name, offset=(5, 5)):
    """A point with a letter, as the source marks ends and crossings of curves."""
    ax.plot([x], [y], "o", color=BLACK, ms=4)
    ax.annotate(name, (x, y), xytext=offset, textcoords="offset points")
