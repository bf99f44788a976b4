/* Solids in a tile of the depth buffer. */
#include "generate/zbuffer_tile.h"

#define SQUARE 8 /* texels of the squares that are looked at together */
#define STEP                                                                                       \
    1.0 /* texels that a texel's middle may differ from its corners before it counts as an edge */

typedef struct Body {
    const WrZSolid *solid;
    double dx, dy; /* from the tile's first texel to the solid's space */
    int x0, x1, y0, y1;
} Body;

static bool body_top(const WrZSheet *sheet, const Body *body, double x, double y, double *z)
{
    return wr_zsolid_top(body->solid, x + body->dx, y + body->dy, z) && *z >= sheet->floor;
}

static WrZBlock *block_of(WrZSheet *sheet, int at)
{
    if (!sheet->block[at]) {
        WrZBlock none;
        for (int s = 0; s < WR_Z_SAMPLES; s++) none.z[s] = -INFINITY;
        wr_array_push(&sheet->blocks, none);
        sheet->block[at] = sheet->blocks.count;
    }
    return &sheet->blocks.data[sheet->block[at] - 1];
}

static void meet(WrZSheet *sheet, int at, unsigned seen)
{
    sheet->mask[at] |= (uint16_t)seen;
    if (sheet->bodies[at] < 2) sheet->bodies[at]++;
}

static void draw_part(WrZSheet *sheet, const Body *body, int x, int y)
{
    int at = y * WR_TILE + x;
    unsigned seen = 0;
    double z[WR_Z_SAMPLES], centre;
    for (int s = 0; s < WR_Z_SAMPLES; s++)
        seen |= (unsigned)body_top(sheet, body, x + wr_z_samples[s][0] / 16.0,
                                   y + wr_z_samples[s][1] / 16.0, &z[s])
                << s;
    if (body_top(sheet, body, x, y, &centre)) wr_z_raise(&sheet->depth[at], centre);
    else if (seen) wr_z_raise(&sheet->edge[at], z[__builtin_ctz(seen)]);
    if (!seen) return;
    WrZBlock *block = block_of(sheet, at);
    for (unsigned left = seen; left; left &= left - 1) {
        int s = __builtin_ctz(left);
        wr_z_raise(&block->z[s], z[s]);
    }
    meet(sheet, at, seen);
}

/* False where its centre is bare. */
static bool draw_whole(WrZSheet *sheet, const Body *body, int x, int y)
{
    int at = y * WR_TILE + x;
    double z;
    if (!body_top(sheet, body, x, y, &z)) return false;
    wr_z_raise(&sheet->depth[at], z);
    wr_z_raise(&sheet->whole[at], z);
    meet(sheet, at, WR_Z_FULL);
    return true;
}

/* Height at the upper left corner of a texel; -inf: bare. */
static double corner(const WrZSheet *sheet, const Body *body, int x, int y)
{
    double z;
    return body_top(sheet, body, x - 0.5, y - 0.5, &z) ? z : -INFINITY;
}

static bool is_covered(const WrZSheet *sheet, const Body *body, int x, int y)
{
    return corner(sheet, body, x, y) > -INFINITY;
}

/* Whether an edge of a solid crosses the texel that hides a lower part of itself. */
static bool hides_itself(const WrZSheet *sheet, const Body *body, int x, int y, double corners)
{
    double z;
    return !wr_zsolid_convex(body->solid) && body_top(sheet, body, x, y, &z) &&
           fabs(0.25 * corners - z) > STEP;
}

/* Texels one by one: one whose four corners are covered counts as covered. Of a convex solid that is so;
 * of others a gap narrower than a texel may close. */
static void draw_texels(WrZSheet *sheet, const Body *body, int x0, int x1, int y0, int y1)
{
    double corners[2][SQUARE + 1];
    for (int y = y0; y <= y1 + 1; y++) {
        double *row = corners[y & 1], *above = corners[(y + 1) & 1];
        for (int x = x0; x <= x1 + 1; x++) row[x - x0] = corner(sheet, body, x, y);
        for (int x = x0; y > y0 && x <= x1; x++) {
            int k = x - x0, at = (y - 1) * WR_TILE + x;
            double sum = row[k] + row[k + 1] + above[k] + above[k + 1];
            bool all = sum > -INFINITY, edge = all && hides_itself(sheet, body, x, y - 1, sum);
            if (all && !edge && draw_whole(sheet, body, x, y - 1)) continue;
            if (!all && wr_zsolid_far(body->solid, x + body->dx, y - 1 + body->dy, 0.75)) continue;
            draw_part(sheet, body, x, y - 1);
            if (edge) sheet->bodies[at] = 2;
        }
    }
}

static void draw_square(WrZSheet *sheet, const Body *body, int x0, int y0)
{
    int x1 = (x0 | (SQUARE - 1)) < body->x1 ? x0 | (SQUARE - 1) : body->x1;
    int y1 = (y0 | (SQUARE - 1)) < body->y1 ? y0 | (SQUARE - 1) : body->y1;
    double mid_x = 0.5 * (x0 + x1) + body->dx, mid_y = 0.5 * (y0 + y1) + body->dy;
    if (wr_zsolid_far(body->solid, mid_x, mid_y, 0.75 * SQUARE)) return;
    /* Solids above the floor are convex where they were, and so are their shadows. */
    bool all = wr_zsolid_convex(body->solid) && is_covered(sheet, body, x0, y0) &&
               is_covered(sheet, body, x1 + 1, y0) && is_covered(sheet, body, x0, y1 + 1) &&
               is_covered(sheet, body, x1 + 1, y1 + 1);
    if (!all) {
        draw_texels(sheet, body, x0, x1, y0, y1);
        return;
    }
    for (int y = y0; y <= y1; y++)
        for (int x = x0; x <= x1; x++)
            if (!draw_whole(sheet, body, x, y)) draw_part(sheet, body, x, y);
}

void wr_zsheet_solid(WrZSheet *sheet, const WrZSolid *solid, double dx, double dy)
{
    Body body = { .solid = solid, .dx = sheet->x - dx, .dy = sheet->y - dy };
    double x = solid->at[0] - body.dx, y = solid->at[1] - body.dy;
    body.x0 = wr_z_clip(floor(x + solid->left), 0, sheet->wide);
    body.x1 = wr_z_clip(ceil(x + solid->right), -1, sheet->wide - 1);
    body.y0 = wr_z_clip(floor(y + solid->top), 0, sheet->high);
    body.y1 = wr_z_clip(ceil(y + solid->bottom), -1, sheet->high - 1);
    /* squares lie by the tile, so that they do not depend on the bounding box's rounding */
    for (int y0 = body.y0 - body.y0 % SQUARE; y0 <= body.y1; y0 += SQUARE)
        for (int x0 = body.x0 - body.x0 % SQUARE; x0 <= body.x1; x0 += SQUARE)
            draw_square(sheet, &body, x0 > body.x0 ? x0 : body.x0, y0 > body.y0 ? y0 : body.y0);
}
