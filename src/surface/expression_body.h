/* expression_body.h - evaluation of a program over n samples, with derivatives, in either precision.

   No include guard (precision.h). Second-order dual numbers: f with its derivatives f_u, f_v, f_uu, f_uv,
   f_vv.

     g(f)      g' f_u,  g'' f_u^2 + g' f_uu,  g'' f_u f_v + g' f_uv, ...
     h(x, y)   h_x x_u + h_y y_u,
               h_xx x_u x_v + h_xy (x_u y_v + x_v y_u) + h_yy y_u y_v + h_x x_uv + h_y y_uv, ...

   A product with a factor of 0 is 0, even if the other factor is unbounded. */

/* Samples side by side, component by component: each operation is a loop over n lanes, so that a program of 20
   operations costs 20 dispatches for 16 samples. */
#undef R_LANES
#define R_LANES 16 /* maximum samples at once */

typedef struct FN(Dual) {
    REAL f[R_LANES], u[R_LANES], v[R_LANES], uu[R_LANES], uv[R_LANES], vv[R_LANES];
} FN(Dual);

/* Values of a function of one or two variables and its derivatives: h, h_x, h_y, h_xx, h_xy, h_yy. */
typedef struct FN(Outer) {
    REAL h[R_LANES], x[R_LANES], y[R_LANES], xx[R_LANES], xy[R_LANES], yy[R_LANES];
} FN(Outer);

/* a b, and 0 where b is 0.
   0 wins over infinity: sqrt(u) at a point where u = 0 and u_u = 0 has derivative 0, not NaN (HC149). */
R_INLINE REAL FN(mul0)(REAL a, REAL b)
{
    return b == K_(0) ? K_(0) : a * b;
}

R_INLINE void FN(dual_one)(int n, const FN(Outer) * g, FN(Dual) * a)
{
    R_EACH for (int i = 0; i < n; i++)
    {
        REAL u = a->u[i], v = a->v[i], one = g->x[i], two = g->xx[i];
        a->f[i] = g->h[i];
        a->u[i] = FN(mul0)(one, u);
        a->v[i] = FN(mul0)(one, v);
        a->uu[i] = FN(mul0)(two, u * u) + FN(mul0)(one, a->uu[i]);
        a->uv[i] = FN(mul0)(two, u * v) + FN(mul0)(one, a->uv[i]);
        a->vv[i] = FN(mul0)(two, v * v) + FN(mul0)(one, a->vv[i]);
    }
}

R_INLINE void FN(dual_two)(int n, const FN(Outer) * g, FN(Dual) * a, const FN(Dual) * b)
{
    R_EACH for (int i = 0; i < n; i++)
    {
        REAL xu = a->u[i], xv = a->v[i], yu = b->u[i], yv = b->v[i];
        REAL hx = g->x[i], hy = g->y[i], xx = g->xx[i], xy = g->xy[i], yy = g->yy[i];
        a->f[i] = g->h[i];
        a->u[i] = FN(mul0)(hx, xu) + FN(mul0)(hy, yu);
        a->v[i] = FN(mul0)(hx, xv) + FN(mul0)(hy, yv);
        a->uu[i] = FN(mul0)(xx, xu * xu) + FN(mul0)(xy, K_(2) * (xu * yu)) + FN(mul0)(yy, yu * yu) +
                   FN(mul0)(hx, a->uu[i]) + FN(mul0)(hy, b->uu[i]);
        a->uv[i] = FN(mul0)(xx, xu * xv) + FN(mul0)(xy, xu * yv + xv * yu) + FN(mul0)(yy, yu * yv) +
                   FN(mul0)(hx, a->uv[i]) + FN(mul0)(hy, b->uv[i]);
        a->vv[i] = FN(mul0)(xx, xv * xv) + FN(mul0)(xy, K_(2) * (xv * yv)) + FN(mul0)(yy, yv * yv) +
                   FN(mul0)(hx, a->vv[i]) + FN(mul0)(hy, b->vv[i]);
    }
}

R_INLINE void FN(dual_set)(int n, const REAL *f, REAL u, REAL v, FN(Dual) * a)
{
    R_EACH for (int i = 0; i < n; i++)
    {
        a->f[i] = f[i];
        a->u[i] = u;
        a->v[i] = v;
        a->uu[i] = a->uv[i] = a->vv[i] = K_(0);
    }
}

/* a + by b */
R_INLINE void FN(dual_add)(int n, REAL by, FN(Dual) * a, const FN(Dual) * b)
{
    R_EACH for (int i = 0; i < n; i++)
    {
        a->f[i] += by * b->f[i];
        a->u[i] += by * b->u[i];
        a->v[i] += by * b->v[i];
        a->uu[i] += by * b->uu[i];
        a->uv[i] += by * b->uv[i];
        a->vv[i] += by * b->vv[i];
    }
}

R_INLINE void FN(dual_neg)(int n, FN(Dual) * a)
{
    R_EACH for (int i = 0; i < n; i++)
    {
        a->f[i] = -a->f[i];
        a->u[i] = -a->u[i];
        a->v[i] = -a->v[i];
        a->uu[i] = -a->uu[i];
        a->uv[i] = -a->uv[i];
        a->vv[i] = -a->vv[i];
    }
}

R_INLINE void FN(dual_mul)(int n, FN(Dual) * a, const FN(Dual) * b)
{
    R_EACH for (int i = 0; i < n; i++)
    {
        REAL x = a->f[i], y = b->f[i], xu = a->u[i], xv = a->v[i], yu = b->u[i], yv = b->v[i];
        a->f[i] = x * y;
        a->u[i] = xu * y + x * yu;
        a->v[i] = xv * y + x * yv;
        a->uu[i] = a->uu[i] * y + K_(2) * (xu * yu) + x * b->uu[i];
        a->uv[i] = a->uv[i] * y + (xu * yv + xv * yu) + x * b->uv[i];
        a->vv[i] = a->vv[i] * y + K_(2) * (xv * yv) + x * b->vv[i];
    }
}

/* The logarithm of x > 0; for other x that of the smallest number.
   log2(R_MIN) is a large negative number: p = 2^(k log2 x) underflows to 0 for x <= 0 without a branch. */
R_INLINE REAL FN(safe_log2)(REAL x)
{
    return r_log2(x > R_MIN ? x : R_MIN);
}

/* x to an integer power, by repeated squaring.
   At most log2(WR_POWER_WHOLE) squarings; signs and 0 are right without a special case. */
R_INLINE REAL FN(whole_power)(REAL x, int power)
{
    const unsigned size = (unsigned)(power < 0 ? -power : power);
    REAL out = K_(1), square = x;
    for (unsigned left = size; left; left >>= 1) {
        out = left & 1 ? out * square : out;
        square = square * square;
    }
    return power < 0 ? K_(1) / out : out;
}

R_INLINE void FN(outer_one)(const WrOp *op, int n, const REAL *f, FN(Outer) * g)
{
    const REAL ln2 = K_(0.69314718055994530942), log2e = K_(1.44269504088896340736);
    const REAL k = (REAL)op->value;
    const int whole = op->code == WR_OP_WHOLE ? (int)op->value : 0;
    switch (op->code) {
    case WR_OP_SQRT:
        R_EACH for (int i = 0; i < n; i++)
        {
            REAL x = f[i] > K_(0) ? f[i] : K_(0), s = r_sqrt(x), d = K_(0.5) / s;
            g->h[i] = s, g->x[i] = d, g->xx[i] = K_(-0.5) * d / x;
        }
        break;
    case WR_OP_SIN:
    case WR_OP_COS:
        R_EACH for (int i = 0; i < n; i++)
        {
            REAL s, c;
            r_sincos_turns(f[i] * K_(0.15915494309189533577), &s, &c);
            int sine = op->code == WR_OP_SIN;
            g->h[i] = sine ? s : c, g->x[i] = sine ? c : -s, g->xx[i] = sine ? -s : -c;
        }
        break;
    case WR_OP_EXP:
        R_EACH for (int i = 0; i < n; i++)
        {
            REAL e = r_exp2(f[i] * log2e);
            g->h[i] = g->x[i] = g->xx[i] = e;
        }
        break;
    case WR_OP_LOG:
        R_EACH for (int i = 0; i < n; i++)
        {
            REAL by = K_(1) / f[i];
            g->h[i] = FN(safe_log2)(f[i]) * ln2, g->x[i] = by, g->xx[i] = -by * by;
        }
        break;
    case WR_OP_ABS:
        R_EACH for (int i = 0; i < n; i++)
        {
            g->h[i] = r_abs(f[i]), g->xx[i] = K_(0);
            g->x[i] = f[i] > K_(0) ? K_(1) : f[i] < K_(0) ? K_(-1) : K_(0);
        }
        break;
    case WR_OP_WHOLE:
        for (int i = 0; i < n; i++) {
            g->h[i] = FN(whole_power)(f[i], whole);
            g->x[i] = whole == 0 ? K_(0) : k * FN(whole_power)(f[i], whole - 1);
            g->xx[i] = whole == 0 || whole == 1
                           ? K_(0)
                           : k * (k - K_(1)) * FN(whole_power)(f[i], whole - 2);
        }
        break;
    default: /* POWER */
        R_EACH for (int i = 0; i < n; i++)
        {
            REAL x = f[i], p = r_exp2(k * FN(safe_log2)(x));
            p = x > K_(0) ? p : K_(0);
            g->h[i] = p, g->x[i] = FN(mul0)(k / x, p),
            g->xx[i] = FN(mul0)(k * (k - K_(1)) / x / x, p);
        }
    }
}

R_INLINE void FN(outer_two)(WrOpCode code, int n, const REAL *f, const REAL *s, FN(Outer) * g)
{
    /* pow(x, y): h_x = y x^(y-1), h_y = h ln x, h_xy = x^(y-1) (1 + y ln x). atan2(y, x), first argument f =
       y: with a = x / r^2 and b = y / r^2 the derivatives by f, s are a, -b; -2 a b, b^2 - a^2, 2 a b. */
    const REAL ln2 = K_(0.69314718055994530942);
    switch (code) {
    case WR_OP_DIV:
        R_EACH for (int i = 0; i < n; i++)
        {
            REAL by = K_(1) / s[i], q = f[i] * by;
            g->h[i] = f[i] / s[i], g->x[i] = by, g->y[i] = -q * by;
            g->xx[i] = K_(0), g->xy[i] = -by * by, g->yy[i] = K_(2) * q * by * by;
        }
        break;
    case WR_OP_POW:
        R_EACH for (int i = 0; i < n; i++)
        {
            REAL x = f[i], y = s[i], l = FN(safe_log2)(x), p = r_exp2(y * l), by = K_(1) / x;
            l = l * ln2;
            g->h[i] = p, g->x[i] = y * p * by, g->y[i] = p * l;
            g->xx[i] = y * (y - K_(1)) * p * by * by;
            g->xy[i] = p * by * (K_(1) + y * l), g->yy[i] = p * l * l;
        }
        break;
    case WR_OP_ATAN2:
        R_EACH for (int i = 0; i < n; i++)
        {
            REAL y = f[i], x = s[i], by = K_(1) / (x * x + y * y), a = x * by, b = y * by;
            g->h[i] = r_atan2(y, x), g->x[i] = a, g->y[i] = -b;
            g->xx[i] = K_(-2) * a * b, g->yy[i] = K_(2) * a * b, g->xy[i] = b * b - a * a;
        }
        break;
    default: /* MIN, MAX: the first one if equal */
        R_EACH for (int i = 0; i < n; i++)
        {
            int first = code == WR_OP_MIN ? f[i] <= s[i] : f[i] >= s[i];
            g->h[i] = first ? f[i] : s[i];
            g->x[i] = first ? K_(1) : K_(0), g->y[i] = first ? K_(0) : K_(1);
            g->xx[i] = g->xy[i] = g->yy[i] = K_(0);
        }
    }
}

/* One operation; `a` is its first operand and receives the result, a[1] is the second operand. */
R_INLINE void FN(program_step)(const WrOp *op, int n, const REAL *u, const REAL *v, FN(Dual) * a)
{
    FN(Outer) g;
    REAL value[R_LANES];
    switch (op->code) {
    case WR_OP_CONST:
        for (int i = 0; i < n; i++) value[i] = (REAL)op->value;
        FN(dual_set)(n, value, K_(0), K_(0), a);
        break;
    case WR_OP_U: FN(dual_set)(n, u, K_(1), K_(0), a); break;
    case WR_OP_V: FN(dual_set)(n, v, K_(0), K_(1), a); break;
    case WR_OP_ADD: FN(dual_add)(n, K_(1), a, a + 1); break;
    case WR_OP_SUB: FN(dual_add)(n, K_(-1), a, a + 1); break;
    case WR_OP_MUL: FN(dual_mul)(n, a, a + 1); break;
    case WR_OP_NEG: FN(dual_neg)(n, a); break;
    case WR_OP_DIV:
    case WR_OP_POW:
    case WR_OP_ATAN2:
    case WR_OP_MIN:
    case WR_OP_MAX:
        FN(outer_two)(op->code, n, a->f, a[1].f, &g);
        FN(dual_two)(n, &g, a, a + 1);
        break;
    default: FN(outer_one)(op, n, a->f, &g); FN(dual_one)(n, &g, a);
    }
}

#undef R_STACK
#define R_STACK (WR_PROGRAM_STACK + 3) /* includes the results */

/* Each operation overwrites its operands on the stack; the results are the lowest entries. */
static __attribute__((noinline)) void
FN(program_run)(const WrProgram *program, int n, const REAL *u, const REAL *v, FN(Dual) * stack)
{
    int top = 0;
    for (int k = 0; k < program->count; k++) {
        const WrOp *op = &program->op[k];
        top -= wr_op_operand_count(op->code);
        FN(program_step)(op, n, u, v, stack + top);
        top++;
    }
}
