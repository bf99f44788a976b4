#include "brush/footprint.h"

#include "base/exactmath.h"
#include "field/field.h"

#include <math.h>

#define SLACK 1e-3 /* texels, as in capsule.c */

/* On a periodic axis shifted near the first period, so that indices fit an int: exact for coordinates
 * on a grid of 2^-16. */
static double near_table(double x, int n, WrWrap wrap)
{
    if (wrap == WR_WRAP_CLAMP || fabs(x) < 2.0 * n) return x;
    return x - n * floor(x / n);
}

static void place(const WrField *field, double x, double y, WrDabShape *shape)
{
    shape->x = near_table(x, wr_field_width(field), wr_field_wrap_u(field));
    shape->y = near_table(y, wr_field_height(field), wr_field_wrap_v(field));
}

bool wr_shape_of_motion(const WrField *field, const WrBrush *brush, double x, double y, double dx,
                        double dy, double pressure_start, double pressure_end, WrDabShape *shape)
{
    if (!(pressure_start > 0.0 || pressure_end > 0.0) || !(brush->radius > WR_THIN)) return false;
    place(field, x, y, shape);
    shape->capsule = wr_capsule(brush, shape->x, shape->y, dx, dy, pressure_start, pressure_end);
    const WrCapsule *c = &shape->capsule;
    shape->kind = c->inverse_length2 > 0.0 ? WR_SHAPE_MOTION : WR_SHAPE_DAB;
    shape->dx = c->dx;
    shape->dy = c->dy;
    shape->reach_x = shape->reach_y = c->radius;
    shape->strongest = c->growth > 0.0 ? c->pressure + c->growth : c->pressure;
    shape->kernels = wr_brush_kernels();
    return true;
}

/* The texel that contains coordinate x. The far end of a clamped axis, u = 1, belongs to the last. */
static double holder(double x, int n, WrWrap wrap)
{
    double cell = floor(x + 0.5);
    return wrap == WR_WRAP_CLAMP && x + 0.5 == n ? n - 1.0 : cell;
}

bool wr_shape_of_texel(const WrField *field, double x, double y, double alpha, WrDabShape *shape)
{
    if (!(alpha > 0.0)) return false;
    place(field, x, y, shape);
    shape->kind = WR_SHAPE_TEXEL;
    shape->x = holder(shape->x, wr_field_width(field), wr_field_wrap_u(field));
    shape->y = holder(shape->y, wr_field_height(field), wr_field_wrap_v(field));
    shape->dx = shape->dy = shape->reach_x = shape->reach_y = 0.0;
    shape->strongest = alpha;
    shape->kernels = wr_brush_kernels();
    return true;
}

/* d^2 = A ex^2 + 2 B ex ey + C ey^2 = R^2 for an ellipse with unit long axis (ux, uy) and aspect s: A C
 * - B^2 = s^2, so its half extents are R sqrt(C) / s across and R sqrt(A) / s down. */
static void set_ellipse(const WrDab *dab, double aspect, double ux, double uy, WrDabShape *shape)
{
    WrEllipse *e = &shape->ellipse;
    double s2 = aspect * aspect;
    *e = (WrEllipse){ .x = shape->x, .y = shape->y, .ux = ux, .uy = uy, .aspect = aspect };
    e->radius2 = dab->radius * dab->radius;
    e->a = ux * ux + s2 * (uy * uy);
    e->b = ux * uy * (1.0 - s2);
    e->c = uy * uy + s2 * (ux * ux);
    double k = dab->hardness < 1e-6         ? 1e-6
               : dab->hardness > 1.0 - 1e-6 ? 1.0 - 1e-6
                                            : dab->hardness;
    e->hardness = (float)k;
    /* libmypaint's falloff over the squared relative distance r: two straight pieces that meet at r = k with the value k:
         1 + r - r / k for r <= k,   k / (1 - k) (1 - r) beyond */
    e->slope_in = (float)(1.0 / k - 1.0);
    e->slope_out = (float)(k / (1.0 - k));
    e->alpha = (float)dab->alpha;
    e->inverse_radius2 = (float)(1.0 / e->radius2);
    e->rounded = dab->falloff == WR_FALLOFF_ROUND;
    WrBrush round = { .radius = dab->radius, .hardness = dab->hardness };
    e->radius = dab->radius;
    e->inner = wr_brush_inner(&round);
    e->inner2 = e->inner * e->inner;
    e->inverse_edge = 1.0 / (e->radius - e->inner);
    shape->kind = WR_SHAPE_ELLIPSE;
    shape->reach_x = dab->radius * sqrt(e->c) / aspect + SLACK;
    shape->reach_y = dab->radius * sqrt(e->a) / aspect + SLACK;
}

static void set_tip(const WrTip *tip, const WrDab *dab, double ux, double uy, WrDabShape *shape)
{
    int width, height;
    wr_tip_size(tip, dab->tip_cell, &width, &height);
    double longer = width > height ? width : height;
    /* The tip's longer side is the dab's diameter. Coordinates s, t = 1/2 + offset / side are 0..1 inside the picture. */
    double length = dab->radius * width / longer;
    double breadth = dab->radius * height / longer / dab->aspect;
    wr_tip_view(tip, dab->tip_cell, 2.0 * dab->radius / longer, &shape->tip);
    shape->kind = WR_SHAPE_TIP;
    shape->ellipse = (WrEllipse){ .x = shape->x, .y = shape->y, .ux = ux, .uy = uy };
    shape->ellipse.alpha = (float)dab->alpha;
    shape->across = 0.5 / length;
    shape->down = 0.5 / breadth;
    shape->reach_x = fabs(ux) * length + fabs(uy) * breadth + SLACK;
    shape->reach_y = fabs(uy) * length + fabs(ux) * breadth + SLACK;
}

/* The aspect limited so that the short axis is not thinner than a texel. */
static double thick_enough(const WrDab *dab)
{
    double most = dab->radius > 1.0 ? dab->radius : 1.0;
    return dab->aspect < most ? dab->aspect : most;
}

bool wr_shape_of_dab(const WrField *field, const WrTip *tip, const WrDab *dab, const WrCopy *copy,
                     WrDabShape *shape)
{
    if (!(dab->radius > 0.0) || !(dab->alpha > 0.0) || !isfinite(dab->x) || !isfinite(dab->y))
        return false;
    double x = copy->a * dab->x + copy->b * dab->y + copy->dx;
    double y = copy->c * dab->x + copy->d * dab->y + copy->dy;
    if (dab->radius <= WR_THIN) return wr_shape_of_texel(field, x, y, dab->alpha, shape);
    double aspect = thick_enough(dab);
    if (!tip && dab->falloff == WR_FALLOFF_ROUND && aspect <= 1.0) {
        WrBrush brush = { .radius = dab->radius, .hardness = dab->hardness };
        return wr_shape_of_motion(field, &brush, x, y, 0.0, 0.0, dab->alpha, dab->alpha, shape);
    }
    place(field, x, y, shape);
    shape->dx = shape->dy = 0.0;
    shape->strongest = dab->alpha;
    shape->kernels = wr_brush_kernels();
    double ux = 1.0, uy = 0.0; /* y down */
    if (dab->angle_rad != 0.0 && (tip || aspect > 1.0)) {
        double sine, cosine;
        wr_sincos_turns(dab->angle_rad / (2.0 * WR_PI), &sine, &cosine);
        ux = cosine;
        uy = -sine;
    }
    double cx = copy->a * ux + copy->b * uy, cy = copy->c * ux + copy->d * uy;
    shape->flips = copy->flips != dab->flips;
    if (tip) set_tip(tip, dab, cx, cy, shape);
    else set_ellipse(dab, aspect, cx, cy, shape);
    return true;
}

/* Row ey of A ex^2 + 2 B ex ey + C ey^2 = R^2: ex = (-B ey +- sqrt(A R^2 - (A C - B^2) ey^2)) / A with A C - B^2 = s^2. */
static bool ellipse_span(const WrEllipse *e, double y, double *low, double *high)
{
    double ey = y - e->y, inside = e->a * e->radius2 - e->aspect * e->aspect * (ey * ey);
    if (!(inside > 0.0)) return false;
    double middle = e->x - e->b * ey / e->a, half = sqrt(inside) / e->a + SLACK;
    *low = middle - half;
    *high = middle + half;
    return true;
}

bool wr_shape_span(const WrDabShape *shape, double y, double *low, double *high)
{
    if (shape->kind == WR_SHAPE_DAB || shape->kind == WR_SHAPE_MOTION)
        return wr_capsule_span(&shape->capsule, y, low, high);
    if (shape->kind == WR_SHAPE_ELLIPSE) return ellipse_span(&shape->ellipse, y, low, high);
    *low = shape->x - shape->reach_x;
    *high = shape->x + shape->reach_x;
    return true;
}

static void tip_row(const WrDabShape *shape, double y, double x, int count, float *fresh)
{
    const WrEllipse *e = &shape->ellipse;
    double ey = y - e->y, side = shape->flips ? -1.0 : 1.0;
    for (int i = 0; i < count; i++) {
        double ex = x + i - e->x;
        double s = 0.5 + (ex * e->ux + ey * e->uy) * shape->across;
        double t = 0.5 + side * (ey * e->ux - ex * e->uy) * shape->down;
        bool inside = s >= 0.0 && s <= 1.0 && t >= 0.0 && t <= 1.0;
        fresh[i] = inside ? e->alpha * wr_tip_value(&shape->tip, s, t) : 0.0f;
    }
}

void wr_shape_row(const WrDabShape *shape, double y, double x, int count, float *fresh)
{
    switch (shape->kind) {
    case WR_SHAPE_TEXEL:
        for (int i = 0; i < count; i++)
            fresh[i] = x + i == shape->x && y == shape->y ? (float)shape->strongest : 0.0f;
        break;
    case WR_SHAPE_DAB: shape->kernels->dab(&shape->capsule, y, x, count, fresh); break;
    case WR_SHAPE_MOTION: shape->kernels->motion(&shape->capsule, y, x, count, fresh); break;
    case WR_SHAPE_ELLIPSE:
        (shape->ellipse.rounded ? shape->kernels->ellipse
                                : shape->kernels->soft)(&shape->ellipse, y, x, count, fresh);
        break;
    case WR_SHAPE_TIP: tip_row(shape, y, x, count, fresh); break;
    }
}
