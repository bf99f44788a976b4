/* Chains: links of round wire, alternately flat and upright, each through the next. */
#include "generate/pattern.h"

#include "base/error.h"

#include <math.h>

const WrParam wr_params_chain[] = {
    WR_P_WHOLE("across", "Across", 4, 1, WR_CELLS_MAX, 32, "pairs of links along each chain"),
    WR_P_WHOLE("rows", "Rows", 4, 1, WR_CELLS_MAX, 32, "chains side by side"),
    WR_P_ALONG,
    WR_P_PART("width", "Width", 0.8, "width of the flat links, relative to the distance of chains"),
    WR_P_NUMBER("wire", "Wire", 0.26, 0.02, 0.3, 0.3, "",
                "thickness of the wire, relative to a link's width"),
    WR_P_HEIGHT,
    WR_P_ORIGIN,
    WR_P_END
};

typedef struct Chain {
    WrCells cells;
    double wire;     /* radius of the wire, texels */
    double bend;     /* radius of a link's round ends, to the middle of the wire */
    double straight; /* half of a link's straight part */
    double most;     /* maximum height, texels */
} Chain;

/* Height of a flat link, its axis along x, its middle at the origin; below 0: none. */
static double flat_link(const Chain *c, double x, double y)
{
    double past = fabs(x) - c->straight;
    double across = past > 0.0 ? sqrt(past * past + y * y) : fabs(y);
    double d = across - c->bend, rest = c->wire * c->wire - d * d;
    return rest > 0.0 ? sqrt(rest) : -1.0;
}

/* Height of an upright link: its wire runs up to `bend` above the ground and down again at both ends.
 * There it is part of a torus, (sqrt(past^2 + z^2) - bend)^2 + y^2 = wire^2. */
static double upright_link(const Chain *c, double x, double y)
{
    double rest = c->wire * c->wire - y * y;
    if (rest <= 0.0) return -1.0;
    double outer = c->bend + sqrt(rest), past = fabs(x) - c->straight;
    if (past <= 0.0) return outer;
    double left = outer * outer - past * past;
    return left > 0.0 ? sqrt(left) : -1.0;
}

static double chain_at(const void *ctx, double x, double y)
{
    const Chain *c = ctx;
    wr_cells_turn(&c->cells, &x, &y);
    double length = c->cells.cell_width, v = y / c->cells.cell_height;
    double dy = (v - floor(v) - 0.5) * c->cells.cell_height;
    /* flat links at 0 and length, upright ones in the middle */
    double dx = x - length * floor(x / length);
    double h = flat_link(c, dx, dy), far = flat_link(c, dx - length, dy);
    h = far > h ? far : h;
    for (int k = -1; k <= 1; k++) { /* long links extend into the neighbouring pairs */
        double up = upright_link(c, dx - (k + 0.5) * length, dy);
        h = up > h ? up : h;
    }
    return h > 0.0 ? h / c->most : 0.0;
}

bool wr_pattern_chain(const WrParamValue *values, const WrGenerateJob *job, WrRelief *out,
                      WrError *err)
{
    const WrParams params = { wr_params_chain, values };
    Chain c = { .cells = wr_cells_directed(&params, job->like) };
    double width = wr_param_number(&params, "width") * c.cells.cell_height;
    double pitch = 0.5 * c.cells.cell_width; /* distance between links */
    c.wire = 0.5 * width * wr_param_number(&params, "wire");
    c.bend = 0.5 * width - c.wire;
    /* A tight chain: the end of one link, bend + straight from its middle, touches the next one's wire
       at a distance of two radii: pitch = 2 (straight + bend) - 2 wire. */
    c.straight = 0.5 * pitch + c.wire - c.bend;
    if (c.straight < 0.0) { /* too short for this width */
        c.straight = 0.0;
        double scale = (0.5 * pitch) / (c.bend - c.wire > 0.0 ? c.bend - c.wire : 1.0);
        if (scale < 1.0) {
            c.bend *= scale;
            c.wire *= scale;
        }
    }
    c.most = c.bend + c.wire;
    if (c.most <= 0.0) c.most = 1.0;
    return wr_pattern_make(&params, job, chain_at, &c, WR_PATTERN_SAMPLES, out, err);
}
