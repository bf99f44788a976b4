/* Drawing of solids in a tile of the depth buffer. */
#include "generate/zbuffer_tile.h"

#define SQUARE WR_Z_SQUARE
#define STEP                                                                                       \
    1.0 /* height difference in texels between a texel's centre and its corners above which it
           counts as an edge */

typedef struct Body {
    const WrZSolid *solid;
    double dx, dy; /* from the tile's first texel to the solid's space */
    int x0, x1, y0, y1;
} Body;

/* Heights at positions of the tile; -inf: uncovered, or below the floor. At most WR_Z_SAMPLES + 1. */
static void body_tops(const WrZSheet *sheet, const Body *body, int count, double *x, double *y,
                      double *z)
{
    for (int i = 0; i < count; i++) {
        x[i] += body->dx;
        y[i] += body->dy;
    }
    wr_zsolid_tops(body->solid, count, x, y, z);
    for (int i = 0; i < count; i++) z[i] = z[i] >= sheet->floor ? z[i] : -INFINITY;
}

/* body_tops along a row: from x on, one texel apart. */
static void row_tops(const WrZSheet *sheet, const Body *body, int count, double x, double y,
                     double *z)
{
    double at_x[SQUARE + 1], at_y[SQUARE + 1];
    for (int i = 0; i < count; i++) {
        at_x[i] = x + i;
        at_y[i] = y;
    }
    body_tops(sheet, body, count, at_x, at_y, z);
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
    double at_x[WR_Z_SAMPLES + 1], at_y[WR_Z_SAMPLES + 1], z[WR_Z_SAMPLES + 1];
    for (int s = 0; s < WR_Z_SAMPLES; s++) {
        at_x[s] = x + wr_z_samples[s][0] / 16.0;
        at_y[s] = y + wr_z_samples[s][1] / 16.0;
    }
    at_x[WR_Z_SAMPLES] = x;
    at_y[WR_Z_SAMPLES] = y;
    body_tops(sheet, body, WR_Z_SAMPLES + 1, at_x, at_y, z);
    for (int s = 0; s < WR_Z_SAMPLES; s++) seen |= (unsigned)(z[s] > -INFINITY) << s;
    double centre = z[WR_Z_SAMPLES];
    if (centre > -INFINITY) wr_z_raise(&sheet->depth[at], centre);
    else if (seen) wr_z_raise(&sheet->edge[at], z[__builtin_ctz(seen)]);
    if (!seen) return;
    WrZBlock *block = block_of(sheet, at);
    for (int s = 0; s < WR_Z_SAMPLES; s++) wr_z_raise(&block->z[s], z[s]);
    meet(sheet, at, seen);
}

/* z: at its centre, covered. */
static void draw_whole(WrZSheet *sheet, int at, double z)
{
    wr_z_raise(&sheet->depth[at], z);
    wr_z_raise(&sheet->whole[at], z);
    meet(sheet, at, WR_Z_FULL);
}

/* True if an edge of a solid crosses the texel and hides a lower part of the same solid. */
static bool hides_itself(const Body *body, double z, double corners)
{
    return !wr_zsolid_convex(body->solid) && z > -INFINITY && fabs(0.25 * corners - z) > STEP;
}

/* Draws texels one by one: a texel with four covered corners counts as covered. This is exact for
 * convex solids; in others a gap narrower than a texel may close. */
static void draw_texels(WrZSheet *sheet, const Body *body, int x0, int x1, int y0, int y1)
{
    double corners[2][SQUARE + 1], middles[SQUARE];
    for (int y = y0; y <= y1 + 1; y++) {
        double *row = corners[y & 1], *above = corners[(y + 1) & 1];
        row_tops(sheet, body, x1 - x0 + 2, x0 - 0.5, y - 0.5, row);
        if (y > y0) row_tops(sheet, body, x1 - x0 + 1, x0, y - 1, middles);
        for (int x = x0; y > y0 && x <= x1; x++) {
            int k = x - x0, at = (y - 1) * WR_TILE + x;
            double sum = row[k] + row[k + 1] + above[k] + above[k + 1];
            bool all = sum > -INFINITY, edge = all && hides_itself(body, middles[k], sum);
            if (all && !edge && middles[k] > -INFINITY) {
                draw_whole(sheet, at, middles[k]);
                continue;
            }
            if (!all && wr_zsolid_far(body->solid, x + body->dx, y - 1 + body->dy, 0.75)) continue;
            draw_part(sheet, body, x, y - 1);
            if (edge) sheet->bodies[at] = 2;
        }
    }
}

/* True if all corners are covered, and so the whole square for a convex solid: the part above the floor
 * and its projection are convex too. */
static bool is_all_covered(const WrZSheet *sheet, const Body *body, int x0, int x1, int y0, int y1)
{
    double x[4] = { x0 - 0.5, x1 + 0.5, x0 - 0.5, x1 + 0.5 };
    double y[4] = { y0 - 0.5, y0 - 0.5, y1 + 0.5, y1 + 0.5 }, z[4];
    if (!wr_zsolid_convex(body->solid)) return false;
    body_tops(sheet, body, 4, x, y, z);
    return z[0] > -INFINITY && z[1] > -INFINITY && z[2] > -INFINITY && z[3] > -INFINITY;
}

static void draw_square(WrZSheet *sheet, const Body *body, int x0, int y0)
{
    int x1 = (x0 | (SQUARE - 1)) < body->x1 ? x0 | (SQUARE - 1) : body->x1;
    int y1 = (y0 | (SQUARE - 1)) < body->y1 ? y0 | (SQUARE - 1) : body->y1;
    double mid_x = 0.5 * (x0 + x1) + body->dx, mid_y = 0.5 * (y0 + y1) + body->dy;
    if (wr_zsolid_far(body->solid, mid_x, mid_y, 0.75 * SQUARE)) return;
    sheet->squares++;
    if (!is_all_covered(sheet, body, x0, x1, y0, y1)) {
        draw_texels(sheet, body, x0, x1, y0, y1);
        return;
    }
    for (int y = y0; y <= y1; y++) {
        double row[SQUARE];
        row_tops(sheet, body, x1 - x0 + 1, x0, y, row);
        for (int x = x0; x <= x1; x++) {
            if (row[x - x0] > -INFINITY) draw_whole(sheet, y * WR_TILE + x, row[x - x0]);
            else draw_part(sheet, body, x, y);
        }
    }
}

static Body body_of(const WrZSheet *sheet, const WrZSolid *solid, double dx, double dy)
{
    Body body = { .solid = solid, .dx = sheet->x - dx, .dy = sheet->y - dy };
    double x = solid->at[0] - body.dx, y = solid->at[1] - body.dy;
    body.x0 = wr_z_clip(floor(x + solid->left), 0, sheet->wide);
    body.x1 = wr_z_clip(ceil(x + solid->right), -1, sheet->wide - 1);
    body.y0 = wr_z_clip(floor(y + solid->top), 0, sheet->high);
    body.y1 = wr_z_clip(ceil(y + solid->bottom), -1, sheet->high - 1);
    return body;
}

/* Squares are aligned to the tile, so that they do not depend on the bounding box's rounding. */
void wr_zsheet_solid(WrZSheet *sheet, const WrZSolid *solid, double dx, double dy)
{
    Body body = body_of(sheet, solid, dx, dy);
    for (int y0 = body.y0 - body.y0 % SQUARE; y0 <= body.y1; y0 += SQUARE)
        for (int x0 = body.x0 - body.x0 % SQUARE; x0 <= body.x1; x0 += SQUARE)
            draw_square(sheet, &body, x0 > body.x0 ? x0 : body.x0, y0 > body.y0 ? y0 : body.y0);
}

void wr_zsheet_solid_at(WrZSheet *sheet, const WrZSolid *solid, double dx, double dy, int x, int y)
{
    Body body = body_of(sheet, solid, dx, dy);
    if (body.x1 < x || body.x0 >= x + SQUARE || body.y1 < y || body.y0 >= y + SQUARE) return;
    draw_square(sheet, &body, x > body.x0 ? x : body.x0, y > body.y0 ? y : body.y0);
}

void wr_zsheet_ring_at(WrZSheet *sheet, const WrZSolid *ring, double dx, double dy, int x, int y,
                       uint64_t texels)
{
    double at_x[SQUARE * SQUARE], at_y[SQUARE * SQUARE], z[SQUARE * SQUARE];
    int at[SQUARE * SQUARE], count = 0;
    do {
        int k = __builtin_ctzll(texels), i = x + k % SQUARE, j = y + k / SQUARE;
        at[count] = j * WR_TILE + i;
        at_x[count] = i + (sheet->x - dx);
        at_y[count++] = j + (sheet->y - dy);
        texels &= texels - 1;
    } while (texels);
    sheet->squares++;
    wr_zsolid_tops(ring, count, at_x, at_y, z);
    for (int k = 0; k < count; k++) draw_whole(sheet, at[k], z[k]);
}
