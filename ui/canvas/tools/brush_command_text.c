#include "ui/canvas/tools/brush_command_text.h"
#include "ui/app/state/line.h"

#include "base/text.h"
#include "brush/brush.h"
#include "brush/symmetry.h"
#include "brush/tip.h"

static void number_unless(WrText *line, const char *name, double value, double base)
{
    if (value != base) wr_line_number(line, name, value);
}

static void flag_unless(WrText *line, const char *name, bool value, bool base)
{
    if (value != base) wr_text_addf(line, " %s=%s", name, value ? "on" : "off");
}

static void pair(WrText *line, const char *name, double x, double y)
{
    wr_line_number(line, name, x);
    wr_text_add(line, ",");
    wr_text_add_number(line, y);
}

static void add_names(WrText *line, const WrBrushNames *names)
{
    if (names->preset && names->preset[0]) wr_line_text(line, "preset", names->preset);
    if (names->set && names->set[0]) wr_line_text(line, "set", names->set);
    if (names->tip && names->tip[0]) wr_line_text(line, "tip", names->tip);
}

static void add_shape(WrText *line, const WrBrush *b, const WrBrush *base)
{
    number_unless(line, "angle", b->angle_deg, base->angle_deg);
    number_unless(line, "aspect", b->aspect, base->aspect);
    flag_unless(line, "follow", b->follow, base->follow);
    if (b->jitter_place == base->jitter_place && b->jitter_angle_deg == base->jitter_angle_deg &&
        b->jitter_size == base->jitter_size)
        return;
    pair(line, "jitter", b->jitter_place, b->jitter_angle_deg);
    wr_text_add(line, ",");
    wr_text_add_number(line, b->jitter_size);
}

static void add_symmetry(WrText *line, const WrSymmetry *s)
{
    int mirror = (s->mirror_u ? 1 : 0) | (s->mirror_v ? 2 : 0);
    int across = s->repeat_u > 1 ? s->repeat_u : 1, down = s->repeat_v > 1 ? s->repeat_v : 1;
    if (mirror) wr_text_addf(line, " mirror=%s", wr_mirror_names[mirror]);
    if (s->radial > 1) wr_text_addf(line, " radial=%d", s->radial);
    if ((mirror || s->radial > 1) && (s->centre_u != 0.5 || s->centre_v != 0.5))
        pair(line, "centre", s->centre_u, s->centre_v);
    if (across == 1 && down == 1 && s->stagger == 0.0) return;
    wr_text_addf(line, " repeat=%dx%d", across, down);
    number_unless(line, "stagger", s->stagger, 0.0);
}

void wr_brush_line(WrText *line, const WrBrush *b, const WrBrush *base, const WrBrushNames *names)
{
    unsigned uses = wr_brush_modes[b->mode].uses;
    add_names(line, names);
    wr_line_number(line, "radius", b->radius);
    wr_line_number(line, "hardness", b->hardness);
    wr_line_number(line, "strength", b->strength);
    wr_text_addf(line, " mode=%s", wr_brush_modes[b->mode].name);
    if (uses & WR_USES_TO) wr_line_number(line, "to", b->to);
    number_unless(line, "opacity", b->opacity, base->opacity);
    number_unless(line, "flow", b->flow, base->flow);
    flag_unless(line, "buildup", b->buildup, base->buildup);
    number_unless(line, "spacing", b->spacing, base->spacing);
    if (uses & WR_USES_REACH) number_unless(line, "reach", b->reach, base->reach);
    if (b->pressure != base->pressure)
        wr_text_addf(line, " pressure=%s", wr_brush_pressures[b->pressure]);
    if (uses & WR_USES_SOURCE) pair(line, "source", b->source_u, b->source_v);
    add_shape(line, b, base);
    add_symmetry(line, &b->symmetry);
    if (b->seed) wr_text_addf(line, " seed=%llu", (unsigned long long)b->seed);
}

bool wr_brush_chances(const WrBrush *b)
{
    return b->preset || b->jitter_place > 0.0 || b->jitter_angle_deg > 0.0 ||
           b->jitter_size > 0.0 || (b->tip && wr_tip_cells(b->tip) > 1);
}
