/* equation.h - P = (x, y, z)(u, v) by three user expressions (expression.h), with exact derivatives.

     N = Pu x Pv

   Where N = 0, n is its first nonzero Taylor coefficient towards the middle of the square, as in
   bezier.h, up to second derivatives. NaN or unbounded values between the points that were checked are
   replaced by 0. */
#include "surface/expression_body.h"

R_INLINE VEC FN(tame)(REAL x, REAL y, REAL z, REAL size)
{
    const REAL most = sizeof(REAL) == 4 ? K_(1e12) : K_(1e100);
    x *= size, y *= size, z *= size;
    return (VEC){ r_is_finite(x) && r_abs(x) < most ? x : K_(0),
                  r_is_finite(y) && r_abs(y) < most ? y : K_(0),
                  r_is_finite(z) && r_abs(z) < most ? z : K_(0) };
}

/* Point i from the three results. */
R_INLINE void FN(formula_point)(const FN(Dual) * d, int i, REAL size, REAL u, REAL v, POINT *o)
{
    const VEC zero = { 0, 0, 0 };
    o->p = FN(tame)(d[0].f[i], d[1].f[i], d[2].f[i], size);
    o->pu = FN(tame)(d[0].u[i], d[1].u[i], d[2].u[i], size);
    o->pv = FN(tame)(d[0].v[i], d[1].v[i], d[2].v[i], size);
    o->puu = FN(tame)(d[0].uu[i], d[1].uu[i], d[2].uu[i], size);
    o->puv = FN(tame)(d[0].uv[i], d[1].uv[i], d[2].uv[i], size);
    o->pvv = FN(tame)(d[0].vv[i], d[1].vv[i], d[2].vv[i], size);
    REAL twist = FN(bezier_size)(o->puv);
    REAL su = FN(bezier_size)(o->pu) + FN(bezier_size)(o->puu) + twist;
    REAL sv = FN(bezier_size)(o->pv) + FN(bezier_size)(o->pvv) + twist;
    FN(bezier_frame)(u, v, zero, zero, R_NOISE * su * sv, o);
}

/* Up to R_LANES samples. */
R_INLINE void FN(formula_many)(const SHAPE *shape, int n, const REAL *u, const REAL *v, POINT *o)
{
    FN(Dual) stack[R_STACK];
    FN(program_run)(&shape->data->program, n, u, v, stack);
    for (int i = 0; i < n; i++) FN(formula_point)(stack, i, (REAL)shape->scale, u[i], v[i], &o[i]);
}

R_INLINE void FN(formula_at)(const SHAPE *shape, int face, REAL u, REAL v, POINT *o)
{
    (void)face;
    FN(formula_many)(shape, 1, &u, &v, o);
}

#ifndef WR_FORMULA_FLOAT
/* Description of an error in an operation's operands; NULL: none. */
static const char *formula_domain(const WrOp *op, const Dual_d *a)
{
    const double x = a->f[0], y = a[1].f[0], k = op->value;
    const bool still =
        a->u[0] == 0 && a->v[0] == 0 && a->uu[0] == 0 && a->uv[0] == 0 && a->vv[0] == 0;
    switch (op->code) {
    case WR_OP_SQRT:
        return x < 0              ? "the root of a number below 0"
               : x == 0 && !still ? "the root has no slope at 0"
                                  : NULL;
    case WR_OP_LOG: return x > 0 ? NULL : "the logarithm of a number that is not above 0";
    case WR_OP_DIV: return y == 0 ? "division by 0" : NULL;
    case WR_OP_WHOLE: return x == 0 && k < 0 ? "division by 0" : NULL;
    case WR_OP_POWER:
        return x < 0                                     ? "a power of a number below 0"
               : x == 0 && !(k > 2) && !(still && k > 0) ? "this power has no slope or bend at 0"
                                                         : NULL;
    case WR_OP_POW: return x > 0 ? NULL : "a power of a number that is not above 0";
    case WR_OP_ATAN2: return x == 0 && y == 0 ? "atan2(0,0) is no angle" : NULL;
    default: return NULL;
    }
}

static bool formula_finite(const Dual_d *a)
{
    return isfinite(a->f[0]) && isfinite(a->u[0]) && isfinite(a->v[0]) && isfinite(a->uu[0]) &&
           isfinite(a->uv[0]) && isfinite(a->vv[0]);
}

/* Evaluates the program at one point; ends[k]: end of expression k. Fails if a value or derivative is
 * undefined there. */
static bool formula_try(const WrProgram *program, const int ends[3], double u, double v,
                        Dual_d *stack, WrError *err)
{
    for (int k = 0, top = 0; k < program->count; k++, top++) {
        const WrOp *op = &program->op[k];
        top -= wr_op_operand_count(op->code);
        const char *why = formula_domain(op, stack + top);
        program_step_d(op, 1, &u, &v, stack + top);
        if (!why && !formula_finite(stack + top)) why = "the value is too large";
        if (!why) continue;
        return wr_fail(err, "formula %s: column %d: %s, at u = %.6g, v = %.6g",
                       k < ends[0]   ? "x"
                       : k < ends[1] ? "y"
                                     : "z",
                       op->column, why, u, v);
    }
    return true;
}

#define FORMULA_STEPS 64

static bool formula_make(WrSurfaceData *data, WrError *err)
{
    static const char *const names[3] = { "formula x", "formula y", "formula z" };
    int ends[3];
    double low[3] = { INFINITY, INFINITY, INFINITY }, high[3] = { -INFINITY, -INFINITY, -INFINITY };
    Dual_d stack[R_STACK];
    for (int k = 0; k < 3; k++) {
        if (!wr_expression_read(names[k], data->text[k], &data->program, err)) return false;
        ends[k] = data->program.count;
    }
    const int across = FORMULA_STEPS + 1;
    for (int i = 0; i < across * across; i++) {
        const double u = i % across / (double)FORMULA_STEPS, v = i / across / (double)FORMULA_STEPS;
        if (!formula_try(&data->program, ends, u, v, stack, err)) return false;
        for (int k = 0; k < 3; k++) {
            low[k] = fmin(low[k], stack[k].f[0]);
            high[k] = fmax(high[k], stack[k].f[0]);
        }
    }
    data->centre =
        (WrVec3){ low[0] / 2 + high[0] / 2, low[1] / 2 + high[1] / 2, low[2] / 2 + high[2] / 2 };
    const WrVec3 half = { high[0] / 2 - low[0] / 2, high[1] / 2 - low[1] / 2,
                          high[2] / 2 - low[2] / 2 };
    if (!(v3_len(half) >= WR_LENGTH_MIN) || !(v3_len(half) + v3_len(data->centre) <= WR_LENGTH_MAX))
        return wr_fail(err, "formula: a size of %g about a middle %g away: must be 1e-30..1e+30",
                       v3_len(half), v3_len(data->centre));
    double most = 0;
    for (int i = 0; i < across * across; i++) {
        const double u = i % across / (double)FORMULA_STEPS, v = i / across / (double)FORMULA_STEPS;
        formula_try(&data->program, ends, u, v, stack, NULL);
        const WrVec3 p = { stack[0].f[0], stack[1].f[0], stack[2].f[0] };
        most = fmax(most, v3_len(v3_sub(p, data->centre)));
    }
    data->radius = 1.01 * most; /* margin for points between the samples */
    return true;
}

static const WrSurfaceInfo formula_row = {
    .name = "formula",
    .label = "Formula",
    .help = "three formulas of your own in u and v: numbers, pi, + - * / ^, sqrt, sin, cos, exp, "
            "log, abs, pow, "
            "atan2, min, max; angles in radians",
    .texts = { { "x", "x", "2*u-1", "x of the point at u, v, as in cos(2*pi*u)", "EXPRESSION" },
               { "y", "y", "2*v-1", "y of the point", "EXPRESSION" },
               { "z", "z", "0.25*sin(3*pi*u)*sin(2*pi*v)", "z of the point", "EXPRESSION" } },
    .make = formula_make,
    .pose_deg = { -40, 0, -25 },
    .open = true,
    .faces = 1,
    .inversion = WR_INVERT_MESH,
    .at = formula_at_d,
};
#endif
