"""A line chart with ranges as SVG, for the studies' pictures. Colours are safe for the colour-blind."""
COLOURS = ["#0072b2", "#d55e00"]
DASHES = ["", "6 4"]
WIDTH, HEIGHT, LEFT, BOTTOM, TOP, RIGHT = 640, 320, 60, 48, 20, 90


def chart(x_title, y_title, ticks, lines, top, step):
    """lines: name -> a (mean, least, most) for each of the ticks, which stand side by side. The y axis goes from 0 to
    top in steps."""
    def x(i, shift=0):
        return LEFT + (i + 0.5) * (WIDTH - LEFT - RIGHT) / len(ticks) + shift

    def y(value):
        return HEIGHT - BOTTOM - value / top * (HEIGHT - BOTTOM - TOP)

    def text(at_x, at_y, words, anchor="middle", more=""):
        return f'<text x="{at_x:.1f}" y="{at_y:.1f}" text-anchor="{anchor}"{more}>{words}</text>'

    parts = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" font-family="sans-serif" font-size="13">',
             f'<rect width="{WIDTH}" height="{HEIGHT}" fill="white"/>']
    for k in range(round(top / step) + 1):
        height = y(k * step)
        parts.append(f'<path d="M{LEFT} {height:.1f}H{WIDTH - RIGHT}" stroke="#ddd"/>')
        parts.append(text(LEFT - 8, height + 4, f"{k * step:.1f}", "end"))
    parts += [text(x(i), HEIGHT - BOTTOM + 18, tick) for i, tick in enumerate(ticks)]
    parts.append(text((LEFT + WIDTH - RIGHT) / 2, HEIGHT - 8, x_title))
    middle = (HEIGHT - BOTTOM + TOP) / 2
    parts.append(text(16, middle, y_title, more=f' transform="rotate(-90 16 {middle:.1f})"'))
    for (name, points), colour, dash, shift in zip(lines.items(), COLOURS, DASHES, (-4, 4)):
        places = [(x(i, shift), *map(y, point)) for i, point in enumerate(points)]
        path = "L".join(f"{px:.1f} {mean:.1f}" for px, mean, _, _ in places)
        parts.append(f'<path d="M{path}" fill="none" stroke="{colour}" stroke-width="2" stroke-dasharray="{dash}"/>')
        for px, mean, least, most in places:
            parts.append(f'<path d="M{px:.1f} {least:.1f}V{most:.1f}" stroke="{colour}" opacity="0.6"/>')
            parts.append(f'<circle cx="{px:.1f}" cy="{mean:.1f}" r="4" fill="{colour}"/>')
        parts.append(text(places[-1][0] + 10, places[-1][1] + (-6 if shift < 0 else 14), name, "start", f' fill="{colour}"'))
    return "\n".join(parts + ["</svg>"]) + "\n"
