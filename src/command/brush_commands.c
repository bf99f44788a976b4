/* The brush as commands: dab, stroke. */
#include "base/error.h"
#include "base/progress.h"
#include "command/args.h"
#include "command/brush_args.h"
#include "command/commands.h"
#include "field/ramp.h"
#include "field/select.h"

static bool run_dab(WrSession *session, WrCall *call, WrError *err)
{
    WrPainting painting;
    if (!wr_painting_begin(session, call, &painting, err)) return false;
    const WrArg *at = wr_call_arg(call, "u,v");
    wr_brush_dab_on(&painting.ground, &painting.held.brush, at->numbers[0], at->numbers[1]);
    wr_painting_end(session, &painting);
    return true;
}

static WrSample sample_of(const void *ctx, int i)
{
    const WrArg *points = ctx;
    const double *row = points->numbers + (size_t)6 * (size_t)i;
    return (WrSample){ row[0], row[1], points->counts[i] > 2 ? row[2] : 1, row[3], row[4], row[5] };
}

static bool run_stroke(WrSession *session, WrCall *call, WrError *err)
{
    WrPainting painting;
    if (!wr_painting_begin(session, call, &painting, err)) return false;
    const WrArg *points = wr_call_arg(call, "points");
    bool good = wr_session_draw(&painting, sample_of, points, points->rows, err);
    wr_painting_end(session, &painting);
    return good;
}

static const WrArgSpec args_dab[] = { { PLACE("u,v"), .also = "at", .type = WR_ARG_TUPLE,
                                        .components = 2, .low = -1e9, .high = 1e9,
                                        .help = "the centre; v up" },
                                      { 0 } };

static const WrComponent sample_parts[] = {
    { "u", -1e9, 1e9, false },        { "v", -1e9, 1e9, false },
    { "pressure", -1e9, 1e9, false }, { "tilt_x", -1e9, 1e9, false },
    { "tilt_y", -1e9, 1e9, false },   { "seconds", -1e9, 1e9, false },
};

static const WrArgSpec args_stroke[] = {
    { .name = "points",
      .type = WR_ARG_LIST,
      .required = true,
      .components = 6,
      .parts = sample_parts,
      .counts = TUPLE_OF(2) | TUPLE_OF(3) | TUPLE_OF(5) | TUPLE_OF(6),
      .rows_low = 1,
      .rows_high = WR_POINTS_MAX,
      .shape = "u,v[,pressure[,tilt_x,tilt_y[,seconds]]];...",
      .help = "the pen's samples in order; pressure is clamped to 0..1, tilt to -1..1" },
    { 0 }
};

/* ---- the rows ---- */

const WrCommand wr_command_dab = {
    .name = "dab",
    .kind = WR_CLASS_EDIT,
    .args = args_dab,
    .more = wr_args_brush,
    .run = run_dab,
    .help = "touch the table once with a brush",
    .details = "With tip= it is a stamp. What is given takes the place of the preset's own.",
    .example = "dab 0.5,0.5 radius=40 strength=0.3"
};

const WrCommand wr_command_stroke = {
    .name = "stroke",
    .kind = WR_CLASS_EDIT,
    .args = args_stroke,
    .more = wr_args_brush,
    .run = run_stroke,
    .streams = true,
    .help = "draw a brush along a path",
    .details =
        "The modes up to erode make a texel anew from the height that it had when the stroke "
        "began and the largest coverage it ever had, so crossing one's own stroke does not "
        "double "
        "it; flow= below 1, presets and buildup=on add the dabs up instead. smooth, level, pinch "
        "and smear change what they find, dab by dab. Samples are joined along the shorter way "
        "round. What is given takes the place of the preset's own. Symmetry draws the whole "
        "stroke again: mirrors, turns, and a lattice over the cell.",
    .example = "stroke points=0.1,0.5;0.9,0.5,0.4 radius=12 mode=lower"
};
