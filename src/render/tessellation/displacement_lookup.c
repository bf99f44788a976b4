#include "render/tessellation/displacement_lookup.h"

#include "base/memory.h"
#include "field/scheme_list.h"
#include "field/field.h"
#include "field/scheme.h"

#include <math.h>

/* Coefficients of the interpolating spline of that periodic table, as a table; NULL: no memory. */
static WrField *coefficients_of(const WrField *field, WrError *err)
{
    const int w = wr_field_width(field), h = wr_field_height(field);
    float *values = wr_try_alloc((size_t)w * (size_t)h, sizeof *values, "heights", err);
    WrField *made = values ? wr_field_new(w, h, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0, err) : NULL;
    if (made) {
        wr_field_read_bspline_coefficients(field, 0, 0, w, h, values, (size_t)w);
        wr_field_write(made, 0, 0, w, h, values, (size_t)w);
    }
    wr_free(values);
    return made;
}

bool wr_raised_init(WrRaised *raised, const WrScene *scene, const WrField *field, WrError *err)
{
    *raised = (WrRaised){ .field = field };
    if (scene->analytic.kind != WR_ANALYTIC_OFF || scene->scheme != WR_SCHEME_BSPLINE_FIT ||
        wr_field_wrap_u(field) != WR_WRAP_PERIODIC || wr_field_wrap_v(field) != WR_WRAP_PERIODIC) {
        raised->scene = wr_scene_share(scene);
        return true;
    }
    raised->scene = wr_scene_clone(scene);
    raised->scene->scheme = WR_SCHEME_BSPLINE;
    raised->field = raised->own = coefficients_of(field, err);
    return raised->own != NULL;
}

void wr_raised_fini(WrRaised *raised)
{
    wr_scene_free(raised->scene);
    wr_field_free(raised->own);
    *raised = (WrRaised){ 0 };
}

bool wr_is_raised(const WrScene *scene)
{
    return scene->displaced && scene->height != 0 && !wr_shape_unmoved(&scene->shape);
}

/* A spline through a table's entries exceeds them by less than their range. */
double wr_raised_most(const WrScene *scene, const WrField *field)
{
    float low, high;
    if (scene->analytic.kind != WR_ANALYTIC_OFF)
        return fabs(scene->height) * wr_analytic_amplitude(&scene->analytic);
    wr_field_range(field, &low, &high);
    const double most = fmax(fabs((double)low), fabs((double)high)) + ((double)high - (double)low);
    return fabs(scene->height) * most;
}
