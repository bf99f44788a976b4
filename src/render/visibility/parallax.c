#include "render/visibility/parallax.h"

#include "field/field.h"
#include "field/scheme_list.h"
#include "field/scheme.h"
#include "render/tessellation/dice.h"
#include "scene/scene.h"

#include <math.h>
#include <string.h>

/* Catmull-Rom weights: their absolute values add up to 1.25 per axis, so the spline exceeds the table's range.
   Its slopes are bounded by the differences times 1.5 along an axis and 1.25 across.
   (1.25^2 - 1) / 2 = 0.28125 of the range on either side; 1.5 * 1.25 = 1.875. */
#define OVERSHOOT 0.28125
#define STEEPER 1.875

static double entry(const WrTableCopy *copy, int i, int j)
{
    const ptrdiff_t at = (ptrdiff_t)(j + WR_APRON) * copy->pitch + i + WR_APRON;
    return copy->data ? (double)copy->data[at] : copy->fine[at];
}

/* Ranges of all entries and of the differences of neighbours, one past each border included.
   F and the slopes of schemes with weights in 0..1 stay within these; see OVERSHOOT for the others. */
static void measure(WrHeightBounds *bounds, const WrTableCopy *copy, int width, int height)
{
    bounds->low = INFINITY, bounds->high = -INFINITY;
    bounds->steep[0] = bounds->steep[1] = 0;
    for (int j = -1; j <= height; j++)
        for (int i = -1; i <= width; i++) {
            const double f = entry(copy, i, j);
            bounds->low = fmin(bounds->low, f), bounds->high = fmax(bounds->high, f);
            if (i < width)
                bounds->steep[0] = fmax(bounds->steep[0], fabs(entry(copy, i + 1, j) - f));
            if (j < height)
                bounds->steep[1] = fmax(bounds->steep[1], fabs(entry(copy, i, j + 1) - f));
        }
}

bool wr_parallax_has_shell(const WrShape *shape)
{
    const WrInversion how = wr_surfaces[shape->kind]->inversion;
    return how == WR_INVERT_SPHERE || how == WR_INVERT_CYLINDER;
}

void wr_height_bounds_update(WrHeightBounds *bounds, const WrTable *table, WrScheme scheme,
                             const WrField *field)
{
    const bool fitted = wr_schemes[scheme].taps == WR_TAPS_FITTED;
    const WrCopyKind kind = fitted ? WR_COPY_FITTED : WR_COPY_HEIGHTS;
    const WrTableCopy *copy = &table->copies[kind];
    const uint64_t key = wr_field_key(field);
    if (bounds->known && bounds->key == key && bounds->copy == kind &&
        bounds->precision == copy->precision)
        return;
    *bounds =
        (WrHeightBounds){ .key = key, .copy = kind, .precision = copy->precision, .known = true };
    measure(bounds, copy, wr_field_width(field), wr_field_height(field));
}

/* True if a border of the domain is a single point, as at a pole. axis 0: the border at u = `at`; 1: at v =
   `at`.
   At a pole all u are one point: there is no border that rays could leave through. */
static bool is_point(const WrShape *shape, int axis, double at)
{
    double across = 0, size = 0;
    for (int k = 0; k < 5; k++) {
        const double along = 0.11 + 0.19 * k;
        WrSurfacePoint p;
        wr_surface_at(shape, 0, axis ? along : at, axis ? at : along, &p);
        across = fmax(across, v3_len(axis ? p.pu : p.pv));
        size = fmax(size, v3_len(axis ? p.pv : p.pu));
    }
    return across <= 1e-9 * size;
}

static void note_ends(WrParallax *parallax, const WrShape *shape)
{
    const WrSurfaceInfo *info = wr_surfaces[shape->kind];
    parallax->closed[0] = info->closed_u, parallax->closed[1] = info->closed_v;
    for (int axis = 0; axis < 2; axis++)
        for (int end = 0; end < 2; end++)
            parallax->ends[axis][end] =
                !parallax->closed[axis] && !wr_shape_endless(shape) && !is_point(shape, axis, end);
}

#define FARTHEST 1e15 /* kernel units: replaces values that are not finite */

void wr_parallax_range(const WrScene *scene, const WrHeightBounds *bounds, const WrPlan *plan,
                       double unit, double range[2])
{
    double low = bounds->low, high = bounds->high;
    if (plan->source == WR_SOURCE_FORMULA) {
        high = wr_analytic_amplitude(&scene->analytic), low = -high;
    } else if (plan->scheme == WR_SCHEME_CATMULL) {
        const double more = OVERSHOOT * (high - low);
        low -= more, high += more;
    }
    range[0] = fmax(fmin(low * unit, high * unit), -FARTHEST);
    range[1] = fmin(fmax(low * unit, high * unit), FARTHEST);
}

/* steep: largest |dF| in object space per unit of u or v, a Lipschitz constant that bounds the step. Infinite
   for formulas and for nearest, which jumps. */
void wr_parallax_fill(WrParallax *parallax, const WrScene *scene, const WrField *field,
                      const WrHeightBounds *bounds, const WrPlan *plan, double scale)
{
    const bool formula = plan->source == WR_SOURCE_FORMULA;
    const double unit = scene->height * scale;
    const double repeat[2] = { fabs(scene->replicate_u), fabs(scene->replicate_v) };
    double range[2];
    *parallax = (WrParallax){ .steps = plan->steps,
                              .bent = !wr_surfaces[scene->shape.kind]->flat,
                              .shell = wr_parallax_has_shell(&scene->shape) };
    note_ends(parallax, &scene->shape);
    wr_parallax_range(scene, bounds, plan, unit, range);
    parallax->low = range[0], parallax->high = range[1];
    for (int axis = 0; axis < 2; axis++) {
        const int texels = formula ? 0 : axis ? wr_field_height(field) : wr_field_width(field);
        const double steep =
            bounds->steep[axis] * (plan->scheme == WR_SCHEME_CATMULL ? STEEPER : 1);
        const bool known = !formula && plan->scheme != WR_SCHEME_NEAREST;
        parallax->texels[axis] = repeat[axis] * texels;
        parallax->steep[axis] = known ? steep * repeat[axis] * texels * fabs(unit) : INFINITY;
    }
}
