"""Lines over x as a PNG, by gnuplot: enough for the examples; any plotting library takes the same arrays."""
import subprocess


def lines(path, title, xlabel, ylabel, x, curves, style="lines", extra=""):
    """curves: label -> values, one for each x."""
    plots = ", ".join(f"'-' with {style} title '{label}'" for label in curves)
    data = "".join("".join(f"{a} {b}\n" for a, b in zip(x, values)) + "e\n" for values in curves.values())
    commands = (f"set terminal pngcairo size 900,500; set output '{path}'; set title '{title}'; set grid; "
                f"set xlabel '{xlabel}'; set ylabel '{ylabel}'; {extra}\nplot {plots}\n{data}")
    subprocess.run(["gnuplot"], input=commands, text=True, check=True)
    print(f"wrote {path}")
