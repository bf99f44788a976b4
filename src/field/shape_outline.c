#include "field/shape_outline.h"

#include "base/array.h"
#include "base/error.h"
#include "base/exactmath.h"
#include "field/field.h"

#include <math.h>
#include <string.h>

typedef WR_ARRAY(WrSelectPoint) Points;

/* In texels, y up. */
typedef struct Place {
    double x, y;
} Place;

/* A rotation about a centre, and the conversion back to parameters. */
typedef struct Turn {
    double width, height;
    Place middle;
    double sine, cosine;
} Turn;

void wr_shape_outline_fini(WrShapeOutline *figure)
{
    wr_free(figure->points);
    *figure = (WrShapeOutline){ 0 };
}

static bool check(WrSelectPoint p, WrError *err)
{
    if (fabs(p.u) <= WR_SELECT_REACH && fabs(p.v) <= WR_SELECT_REACH) return true;
    return wr_fail(err, "point %.9g,%.9g of a shape: each must be %d..%d", p.u, p.v,
                   -WR_SELECT_REACH, WR_SELECT_REACH);
}

static bool check_value(const char *name, double value, double high, WrError *err)
{
    if (value >= 0.0 && value <= high) return true;
    return wr_fail(err, "%s %.9g of a shape: must be 0..%.9g", name, value, high);
}

static bool check_turn(double turn_deg, double tolerance, WrError *err)
{
    if (!(fabs(turn_deg) <= 1e6))
        return wr_fail(err, "turn %.9g of a shape: must be -1e6..1e6 degrees", turn_deg);
    if (!(tolerance > 0.0)) return wr_fail(err, "tolerance %.9g: must be above 0", tolerance);
    return true;
}

static void hand_over(Points *points, bool closed, WrShapeOutline *out)
{
    *out = (WrShapeOutline){ points->data, points->count, closed };
}

static Turn turn_about(const WrField *like, double x, double y, double turn_deg)
{
    Turn turn = { wr_field_width(like), wr_field_height(like), { x, y }, 0.0, 1.0 };
    wr_sincos_turns(turn_deg / 360.0, &turn.sine, &turn.cosine);
    return turn;
}

/* Adds the point (x, y) relative to the centre, rotated. */
static void add(Points *points, const Turn *turn, double x, double y)
{
    double tx = turn->middle.x + (x * turn->cosine - y * turn->sine);
    double ty = turn->middle.y + (x * turn->sine + y * turn->cosine);
    wr_array_push(points, ((WrSelectPoint){ tx / turn->width, ty / turn->height }));
}

/* Number of steps of a full circle: its arcs rise r (1 - cos(pi/n)) <= r pi^2 / (2 n^2) above their
 * chords. */
static int circle_steps(double radius, double tolerance)
{
    double n = ceil(WR_PI * sqrt(radius / (2.0 * tolerance)));
    return n < 12.0 ? 12 : n < WR_SHAPE_OUTLINE_POINTS / 2 ? (int)n : WR_SHAPE_OUTLINE_POINTS / 2;
}

/* Adds a quarter circle about (x, y), both ends included, starting at `quarter`. */
static void add_quarter(Points *points, const Turn *turn, double x, double y, double radius,
                        int quarter, int steps)
{
    for (int i = 0; i <= steps; i++) {
        double sine, cosine;
        wr_sincos_turns((quarter + (double)i / steps) / 4.0, &sine, &cosine);
        add(points, turn, x + radius * cosine, y + radius * sine);
    }
}

bool wr_shape_outline_rectangle(const WrField *like, WrSelectPoint a, WrSelectPoint b,
                                double corner, double turn_deg, double tolerance,
                                WrShapeOutline *out, WrError *err)
{
    if (!check(a, err) || !check(b, err) || !check_value("corner", corner, 1e9, err) ||
        !check_turn(turn_deg, tolerance, err))
        return false;
    double width = wr_field_width(like), height = wr_field_height(like);
    double x = 0.5 * width * fabs(b.u - a.u), y = 0.5 * height * fabs(b.v - a.v);
    Turn turn = turn_about(like, 0.5 * width * (a.u + b.u), 0.5 * height * (a.v + b.v), turn_deg);
    /* A corner radius above half of a side is limited to it: the two quarter circles then meet. */
    double r = corner < x ? corner : x;
    if (r > y) r = y;
    int steps = (circle_steps(r, tolerance) + 3) / 4;
    Points points = { 0 };
    static const int sign[4][2] = { { -1, -1 }, { 1, -1 }, { 1, 1 }, { -1, 1 } };
    /* Corners counter-clockwise from the lower left; quarter k of the circle starts at (k + 2) / 4 turns there, so that the
       arc leaves one side and joins the next. */
    for (int k = 0; k < 4; k++) {
        double cx = sign[k][0] * (x - r), cy = sign[k][1] * (y - r);
        if (r > 0.0) add_quarter(&points, &turn, cx, cy, r, (k + 2) % 4, steps);
        else add(&points, &turn, cx, cy);
    }
    hand_over(&points, true, out);
    return true;
}

bool wr_shape_outline_ellipse(const WrField *like, WrSelectPoint middle, WrSelectPoint radii,
                              double turn_deg, double tolerance, WrShapeOutline *out, WrError *err)
{
    if (!check(middle, err) || !check_value("radius", radii.u, WR_SELECT_REACH, err) ||
        !check_value("radius", radii.v, WR_SELECT_REACH, err) ||
        !check_turn(turn_deg, tolerance, err))
        return false;
    double width = wr_field_width(like), height = wr_field_height(like);
    double rx = width * radii.u, ry = height * radii.v;
    Turn turn = turn_about(like, width * middle.u, height * middle.v, turn_deg);
    int steps = circle_steps(rx > ry ? rx : ry, tolerance);
    Points points = { 0 };
    wr_array_reserve(&points, steps);
    for (int i = 0; i < steps; i++) {
        double sine, cosine;
        wr_sincos_turns((double)i / steps, &sine, &cosine);
        add(&points, &turn, rx * cosine, ry * sine);
    }
    hand_over(&points, true, out);
    return true;
}

bool wr_shape_outline_polygon(const WrSelectPoint *points, int count, WrShapeOutline *out,
                              WrError *err)
{
    if (count < 3 || count > WR_SHAPE_OUTLINE_POINTS)
        return wr_fail(err, "a polygon of %d points: must be 3..%d", count,
                       WR_SHAPE_OUTLINE_POINTS);
    for (int i = 0; i < count; i++)
        if (!check(points[i], err)) return false;
    Points made = { 0 };
    wr_array_reserve(&made, count);
    for (int i = 0; i < count; i++) wr_array_push(&made, points[i]);
    hand_over(&made, true, out);
    return true;
}

/* ---- paths ---- */

static double second_difference(const WrField *like, const WrSelectPoint p[3])
{
    double x = wr_field_width(like) * (p[0].u - 2.0 * p[1].u + p[2].u);
    double y = wr_field_height(like) * (p[0].v - 2.0 * p[1].v + p[2].v);
    return sqrt(x * x + y * y);
}

static double between(double a, double b, double t)
{
    return a + t * (b - a);
}

/* De Casteljau's algorithm. */
static WrSelectPoint on_curve(const WrSelectPoint p[4], double t)
{
    WrSelectPoint q[4];
    memcpy(q, p, sizeof q);
    for (int left = 3; left > 0; left--)
        for (int i = 0; i < left; i++)
            q[i] =
                (WrSelectPoint){ between(q[i].u, q[i + 1].u, t), between(q[i].v, q[i + 1].v, t) };
    return q[0];
}

bool wr_shape_outline_path(const WrField *like, const WrSelectPoint *points, int count, bool closed,
                           double tolerance, WrShapeOutline *out, WrError *err)
{
    if (count < 4 || count % 3 != 1)
        return wr_fail(err,
                       "a path of %d points: must be 4, 7, 10, ...: a start, then two handles "
                       "and an end for each curve",
                       count);
    if (!check_turn(0.0, tolerance, err)) return false;
    for (int i = 0; i < count; i++)
        if (!check(points[i], err)) return false;
    Points made = { 0 };
    wr_array_push(&made, points[0]);
    for (int k = 0; k + 3 < count; k += 3) {
        const WrSelectPoint *p = points + k;
        /* B''(t) = 6 ((1 - t) D0 + t D1) with second differences D0, D1 of the control points, hence |B''| <= 6 max(|D0|,
           |D1|). A chord over an interval h deviates by at most |B''| h^2 / 8, so n steps with n^2 >= 6 max / (8 tolerance)
           are within tolerance. */
        double a = second_difference(like, p), b = second_difference(like, p + 1);
        double steps = ceil(sqrt(6.0 * (a > b ? a : b) / (8.0 * tolerance)));
        if (steps < 1.0) steps = 1.0;
        if (made.count + steps > WR_SHAPE_OUTLINE_POINTS) {
            wr_array_free(&made);
            return wr_fail(err, "a path of more than %d pieces", WR_SHAPE_OUTLINE_POINTS);
        }
        /* The end point is copied, not evaluated: consecutive pieces share it bit for bit. */
        for (int i = 1; i < steps; i++) wr_array_push(&made, on_curve(p, i / steps));
        wr_array_push(&made, p[3]);
    }
    hand_over(&made, closed, out);
    return true;
}
