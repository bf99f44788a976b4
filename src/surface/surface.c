#include "surface/surface.h"

#include "base/error.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "base/text.h"
#include "surface/data.h"
#include "surface/precision.h"
#define WR_SURFACE_FORMULAS
#include "surface/surface_list.h"
#undef WR_SURFACE_FORMULAS

/* One file for each surface, listed in surface_list.h, which is included three times: formulas in double,
   rows, enumeration. */
const WrSurfaceInfo *const wr_surfaces[WR_SURFACE_COUNT] = {
#define WR_X(name) [WR_SURFACE_##name] = &name##_row,
#include "surface/surface_list.h"
};

/* Names of rows are the words of documents: they never change, while the order of the list may. */
int wr_surface_find(const char *name)
{
    for (int kind = 0; kind < WR_SURFACE_COUNT; kind++) {
        if (strcmp(wr_surfaces[kind]->name, name) == 0) return kind;
    }
    return -1;
}

static bool kind_exists(WrSurfaceKind kind)
{
    return (int)kind >= 0 && (int)kind < WR_SURFACE_COUNT;
}

/* The next param of a row, or the first for NULL; NULL at the end. */
static const WrSurfaceParam *next_param(const WrSurfaceInfo *info, const WrSurfaceParam *param)
{
    param = param ? param + 1 : info->params;
    bool there = param < info->params + WR_SURFACE_PARAMS && param->name;
    return there ? param : NULL;
}

void wr_shape_default(WrSurfaceKind kind, WrShape *shape)
{
    WR_ASSERT(kind_exists(kind));
    memset(shape, 0, sizeof *shape);
    shape->kind = kind;
    shape->scale = 1;
    wr_shape_borrow_data(shape, wr_surface_data_default(kind));
    double *value = shape->value;
    const WrSurfaceParam *param = NULL;
    while ((param = next_param(wr_surfaces[kind], param))) {
        /* value[] is the row's params one after another, `components` doubles each; there is no index by name. */
        memcpy(value, param->fallback, (size_t)param->components * sizeof *value);
        value += param->components;
    }
}

int wr_surface_param_offset(WrSurfaceKind kind, const char *name)
{
    WR_ASSERT(kind_exists(kind));
    int offset = 0;
    const WrSurfaceParam *param = NULL;
    while ((param = next_param(wr_surfaces[kind], param))) {
        if (strcmp(param->name, name) == 0) return offset;
        offset += param->components;
    }
    return -1;
}

/* ends: only the two limits themselves are valid, as for switches 0 and 1. */
static bool check_param(const WrSurfaceInfo *info, const WrSurfaceParam *param, const double *value,
                        WrError *err)
{
    static const char axis[3] = { 'x', 'y', 'z' };
    for (int i = 0; i < param->components; i++) {
        const bool between = value[i] > param->low && value[i] < param->high;
        if (value[i] >= param->low && value[i] <= param->high && !(param->ends[0] && between))
            continue;
        char number[WR_NUMBER_SIZE], low[WR_NUMBER_SIZE], high[WR_NUMBER_SIZE], part[32] = "";
        if (param->components == 3) snprintf(part, sizeof part, " %c", axis[i]);
        if (param->components > 3)
            snprintf(part, sizeof part, " %d %c", i / 3 + 1, axis[i % 3]); /* of the i-th point */
        return wr_fail(err, "%s %s%s = %s: must be %s%s%s (%s)", info->name, param->name, part,
                       wr_number_print(value[i], number), wr_number_print(param->low, low),
                       param->ends[0] ? " or " : "..", wr_number_print(param->high, high),
                       param->help);
    }
    return true;
}

bool wr_shape_check(const WrShape *shape, WrError *err)
{
    if (!kind_exists(shape->kind))
        return wr_fail(err, "surface number %d: must be 0..%d", (int)shape->kind,
                       WR_SURFACE_COUNT - 1);
    const WrSurfaceInfo *info = wr_surfaces[shape->kind];
    const double *value = shape->value;
    const WrSurfaceParam *param = NULL;
    while ((param = next_param(info, param))) {
        if (!check_param(info, param, value, err)) return false;
        value += param->components;
    }
    return !info->check || info->check(shape, err);
}

/* Meshes and patches hold their own centre, in units before `scale`; formulas have a constant one, or half the
   sides a, b. */
WrVec3 wr_shape_centre(const WrShape *shape)
{
    WR_ASSERT(kind_exists(shape->kind));
    const WrSurfaceInfo *info = wr_surfaces[shape->kind];
    if (shape->data) return v3_scale(shape->data->centre, shape->scale);
    WrVec3 centre = { info->centre[0], info->centre[1], info->centre[2] };
    if (info->held) {
        const double *at = shape->value + WR_MESH_CENTRE;
        if (shape->value[WR_MESH_RADIUS] > 0) return (WrVec3){ at[0], at[1], at[2] };
        return (WrVec3){ 0.5, 0.5, 0 };
    }
    if (info->centre_half_ab) {
        centre.x += shape->value[wr_surface_param_offset(shape->kind, "a")] / 2;
        centre.y += shape->value[wr_surface_param_offset(shape->kind, "b")] / 2;
    }
    return centre;
}

/* The largest distance of 33 x 33 points, plus a hundredth for points between them. A frame needs the radius of one shape several
   times, so each thread keeps the last. Unused bytes of the struct can only make equal shapes differ. */
static double sampled_radius(const WrShape *shape)
{
    enum { STEPS = 32 };
    static _Thread_local struct {
        WrShape shape;
        double radius; /* 0: none yet */
    } last;
    if (last.radius > 0 && memcmp(&last.shape, shape, sizeof *shape) == 0) return last.radius;
    WrVec3 centre = wr_shape_centre(shape);
    double most = 0;
    for (int j = 0; j <= STEPS; j++) {
        for (int i = 0; i <= STEPS; i++) {
            WrSurfacePoint o;
            wr_surface_at(shape, 0, (double)i / STEPS, (double)j / STEPS, &o);
            most = fmax(most, v3_len(v3_sub(o.p, centre)));
        }
    }
    memcpy(&last.shape, shape, sizeof *shape);
    return last.radius = 1.01 * most;
}

/* Never 0: it is a divisor of tolerances and camera distances. */
double wr_shape_radius(const WrShape *shape)
{
    WR_ASSERT(kind_exists(shape->kind));
    const WrSurfaceInfo *info = wr_surfaces[shape->kind];
    double radius = shape->data    ? shape->data->radius * shape->scale
                    : info->radius ? info->radius(shape)
                                   : sampled_radius(shape);
    return radius > 0 ? radius : 1;
}

/* The part of the table's (u, v) that a face shows. */
WrSurfaceCell wr_surface_cell(const WrShape *shape, int face)
{
    const WrSurfaceInfo *info = wr_surfaces[shape->kind];
    if (info->cell) return info->cell(shape, face);
    return (WrSurfaceCell){ 0, 1, 0, 1 };
}

/* value[2] is the plane's switch `endless`, a number like all parameters. */
bool wr_shape_endless(const WrShape *shape)
{
    return wr_surfaces[shape->kind]->endless && shape->value[2] > 0.5;
}

/* Faces of a cube share the table as an atlas with margins; 1 x 1 for all other surfaces. */
void wr_surface_cells(const WrShape *shape, int *columns, int *rows)
{
    const double part = 1 - 2 * WR_CELL_MARGIN;
    const WrSurfaceCell cell = wr_surface_cell(shape, 0);
    const double u = part / (cell.u1 - cell.u0), v = part / (cell.v1 - cell.v0);
    *columns = u > 1 ? (int)lround(u) : 1;
    *rows = v > 1 ? (int)lround(v) : 1;
}

const char *wr_shape_unmoved(const WrShape *shape)
{
    if (wr_surfaces[shape->kind]->held && shape->kind != WR_SURFACE_mesh)
        return "patches and terrains are not displaced";
    if (wr_shape_endless(shape)) return "a plane without end is not displaced";
    return NULL;
}

const char *wr_shape_without_parallax(const WrShape *shape)
{
    int columns, rows;
    wr_surface_cells(shape, &columns, &rows);
    if (wr_surfaces[shape->kind]->held) return "meshes and patches out of files have none";
    if (columns * rows != 1 || wr_surfaces[shape->kind]->faces != 1)
        return "faces that meet at edges have none";
    if (wr_shape_endless(shape)) return "a plane without end has none";
    return NULL;
}

/* A cell extends to the middle of the margin between neighbours: half a column or row on either side of its
   centre. */
int wr_surface_face(const WrShape *shape, int face, double u, double v)
{
    int columns, rows;
    wr_surface_cells(shape, &columns, &rows);
    if (columns * rows == 1) return face;
    for (int i = 0; i < wr_surfaces[shape->kind]->faces; i++) {
        const WrSurfaceCell c = wr_surface_cell(shape, i);
        if (fabs(u - (c.u0 + c.u1) / 2) <= 0.5 / columns &&
            fabs(v - (c.v0 + c.v1) / 2) <= 0.5 / rows)
            return i;
    }
    return face;
}

void wr_surface_at(const WrShape *shape, int face, double u, double v, WrSurfacePoint *out)
{
    WR_ASSERT(kind_exists(shape->kind));
    WR_ASSERT(face >= 0 && face < wr_surfaces[shape->kind]->faces);
    wr_surfaces[shape->kind]->at(shape, face, u, v, out);
}

/* Kernels work in units in which the object's size is near 1: lengths are multiplied by `scale`, angles and
   ratios are not. The clamp keeps the conversion to float finite (HC09). */
void wr_shape_scaled(const WrShape *shape, double scale, WrShapef *out)
{
    WR_ASSERT(kind_exists(shape->kind));
    memset(out, 0, sizeof *out);
    out->data = shape->data;
    out->key = shape->key;
    out->scale = (float)(shape->scale * scale);
    int k = 0;
    const WrSurfaceParam *param = NULL;
    while ((param = next_param(wr_surfaces[shape->kind], param))) {
        for (int i = 0; i < param->components; i++, k++) {
            double value = shape->value[k] * (param->length ? scale : 1);
            out->value[k] = (float)fmax(-FLT_MAX, fmin(value, FLT_MAX));
        }
    }
}
