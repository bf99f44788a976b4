/* Fetches of heights and slopes by the renderer. */
#include "hardcases/hardcases_look.h"

#include "base/error.h"
#include "field/field.h"

bool wr_hard_look_init(WrHardGauge *gauge, WrHardLook *look, const WrField *field, WrScheme scheme,
                       double ru, double rv, WrError *err)
{
    const WrCopyKind kind =
        wr_schemes[scheme].taps == WR_TAPS_FITTED ? WR_COPY_FITTED : WR_COPY_HEIGHTS;
    *look = (WrHardLook){ .scheme = scheme };
    wr_table_init(&look->table);
    if (!wr_table_update(&look->table, kind, field, gauge->pool, err) ||
        !wr_table_update(&look->table, WR_COPY_GRADIENT, field, gauge->pool, err)) {
        wr_table_fini(&look->table);
        return false;
    }
    const WrTableCopy *heights = &look->table.copies[kind];
    look->look = (WrLook){ .heights = heights->data,
                           .gradient = look->table.copies[WR_COPY_GRADIENT].data,
                           .pitch = heights->pitch,
                           .width = wr_field_width(field),
                           .height = wr_field_height(field),
                           .ru = ru,
                           .rv = rv,
                           .periodic_u = wr_field_wrap_u(field) == WR_WRAP_PERIODIC,
                           .periodic_v = wr_field_wrap_v(field) == WR_WRAP_PERIODIC,
                           .wide = true,
                           .scale_f = 1.0f,
                           .scale_u = (float)ru,
                           .scale_v = (float)rv };
    return true;
}

void wr_hard_look_fini(WrHardLook *look)
{
    wr_table_fini(&look->table);
}

WrHardSlope wr_hard_look_at(WrHardGauge *gauge, int set, const WrHardLook *look, float u, float v)
{
    WrStrip *strip = gauge->strip;
    strip->count = 1;
    strip->u[0] = u;
    strip->v[0] = v;
    gauge->kernels[set]->look[look->scheme](&look->look, strip);
    return (WrHardSlope){ (double)strip->f[0], (double)strip->fu[0], (double)strip->fv[0] };
}
