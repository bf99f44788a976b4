/* kern_types_body.h - strips, rays, fetch parameters and the kernel table, written once for single and double
   precision. Part of kern.h, which defines REAL, SHAPE and WR_T(name) (WrStrip, WrStripd) before each inclusion.
   Deliberately without a guard. */

/* The samples of one strip. Members are filled stage by stage; count is the number in use. */
typedef struct WR_T(WrStrip) {
    int count;
    _Alignas(64) int index[WR_SPAN]; /* index of the sample in the row, ascending */
    _Alignas(64) REAL s[WR_SPAN];    /* ray parameter (closed forms) */
    REAL u[WR_SPAN], v[WR_SPAN];     /* patch parameters, 0..1 */
    int triangle[WR_SPAN];           /* of a mesh; only if a normal map uses its tangent frames */
    REAL px[WR_SPAN], py[WR_SPAN], pz[WR_SPAN]; /* P */
    REAL pux[WR_SPAN], puy[WR_SPAN], puz[WR_SPAN];
    REAL pvx[WR_SPAN], pvy[WR_SPAN], pvz[WR_SPAN];
    REAL nx[WR_SPAN], ny[WR_SPAN], nz[WR_SPAN];    /* n, unit */
    REAL n_len[WR_SPAN];                           /* |N| */
    REAL nux[WR_SPAN], nuy[WR_SPAN], nuz[WR_SPAN]; /* dn/du; only if curvature ran */
    REAL nvx[WR_SPAN], nvy[WR_SPAN], nvz[WR_SPAN];
    REAL tu[WR_SPAN], tv[WR_SPAN];              /* position in the table, 0..1 */
    REAL inside_u[WR_SPAN], inside_v[WR_SPAN];  /* 1; 0 beyond the end of a clamped axis */
    int at[WR_SPAN];                            /* first tap in the copies */
    REAL ta[WR_SPAN], tb[WR_SPAN];              /* fractions past it */
    REAL top[4 * WR_SPAN], low[4 * WR_SPAN];    /* taps of the upper and the lower row */
    REAL f[WR_SPAN], fu[WR_SPAN], fv[WR_SPAN];  /* height and replication included */
    REAL bx[WR_SPAN], by[WR_SPAN], bz[WR_SPAN]; /* n', unit, towards the viewer's side */
    REAL vx[WR_SPAN], vy[WR_SPAN], vz[WR_SPAN]; /* unit, towards the viewer */
    REAL lx[WR_SPAN], ly[WR_SPAN], lz[WR_SPAN]; /* unit, towards the current light */
    REAL n_dot_l[WR_SPAN];
    REAL rough[WR_SPAN], metal[WR_SPAN];        /* only if they vary over the surface */
    REAL dr[WR_SPAN], dg[WR_SPAN], db[WR_SPAN]; /* ambient and diffuse sums */
    REAL sr[WR_SPAN], sg[WR_SPAN], sb[WR_SPAN]; /* specular sums */
    REAL cr[WR_SPAN], cg[WR_SPAN], cb[WR_SPAN]; /* C(u,v), then the finished colour */
    /* Position in the sample grid; input of scattered hits and of polish, compacted with the hits. */
    REAL x[WR_SPAN], y[WR_SPAN];
    /* The footprint: steps in the table, texels, of one pixel to the right and of one pixel down. */
    REAL rx[WR_SPAN], ry[WR_SPAN], wx[WR_SPAN], wy[WR_SPAN];
    REAL level[WR_SPAN];                   /* level of the pyramid: 0 .. its last, with fractions */
    REAL long_u[WR_SPAN], long_v[WR_SPAN]; /* the longer side of the footprint, in u and v */
    int taps[WR_SPAN];                     /* fetches along it; 1..WR_TAPS_MAX */
    /* Covariance of the slopes within the footprint, in units of fu, fv. */
    REAL suu[WR_SPAN], suv[WR_SPAN], svv[WR_SPAN];
    /* That covariance in the plane across n', as tangents of angles: along e, across it, and mixed. */
    REAL ex[WR_SPAN], ey[WR_SPAN], ez[WR_SPAN];
    REAL see[WR_SPAN], sef[WR_SPAN], sff[WR_SPAN];
    bool gathered; /* no sample has a spread of slopes: all of these are 0 */
    /* Over the pixel: bounds of u, v; of |P - P at the centre|; of the change of n, of the slopes' vector, of
       n'; and of the intensity. Infinite: unknown. */
    REAL u_low[WR_SPAN], u_high[WR_SPAN], v_low[WR_SPAN], v_high[WR_SPAN];
    REAL reach[WR_SPAN], turn[WR_SPAN];
    REAL fu_low[WR_SPAN], fu_high[WR_SPAN], fv_low[WR_SPAN], fv_high[WR_SPAN];
    REAL swing[WR_SPAN], bound[WR_SPAN];
} WR_T(WrStrip);

/* The ray of sample (gx, gy) of the frame's sample grid: q + s d, with q = q0 + gx qx + gy qy and d of the same
   form. q lies in the plane through the object's centre that faces the camera, so that its size is the object's
   and nothing cancels however far the eye is; with the eye close to the object q is at the eye. */
typedef struct WR_T(WrRays) {
    REAL q0[3], qx[3], qy[3];
    REAL d0[3], dx[3], dy[3];
    REAL s_min; /* smaller s is in front of the near plane */
    bool perspective;
    REAL eye[3];    /* perspective */
    REAL toward[3]; /* orthographic: unit vector towards the viewer */
} WR_T(WrRays);

/* A flat parallelogram with orthogonal edges: plane, or a face of the cube. */
typedef struct WR_T(WrQuad) {
    REAL origin[3], normal[3];
    REAL eu[3], ev[3];   /* Pu / |Pu|^2, Pv / |Pv|^2: dot products give u, v */
    REAL u0, u1, v0, v1; /* range of u and v on it: 0..1, slightly more at a shared edge */
    REAL least, most;    /* u and v are clamped to this range: 0 and 1, unless it is endless */
} WR_T(WrQuad);

/* Fetch parameters of heights: contiguous copies with an apron (height_copies.h). */
typedef struct WR_T(WrLook) {
    const REAL *heights;  /* F, or spline coefficients; texel (i,j) at [(j + A) pitch + i + A] */
    const REAL *gradient; /* central differences dF/du, dF/dv interleaved, same layout */
    int pitch;            /* texels per row */
    int width, height;
    double ru, rv; /* replication */
    bool periodic_u, periodic_v;
    bool wide;                      /* reduces r u in double (E10) */
    REAL scale_f, scale_u, scale_v; /* height; height * ru; height * rv */
    REAL reach; /* limit of footprints, texels: beyond it are other faces' heights; 0: no limit */
    const WrPyramid *pyramid; /* means and covariances of the slopes (slope_pyramid.h); or NULL */
    const WrPyramid *range;   /* least and largest slopes; or NULL */
} WR_T(WrLook);

typedef struct WR_T(WrKernLight) {
    bool point;
    REAL where[3]; /* unit direction towards the light, or its position */
    REAL rgb[3];   /* colour * strength */
    double radius; /* of an area lamp, radians */
    bool shadow;   /* objects can hide it */
} WR_T(WrKernLight);

/* ks, s and the gate of a highlight. */
typedef struct WR_T(WrKernShine) {
    REAL ks, shininess;
    bool gate;
} WR_T(WrKernShine);

/* Material and ambient light. */
typedef struct WR_T(WrKernMaterial) {
    REAL ambient, kd;
    REAL rgb[3]; /* the material's colour */
} WR_T(WrKernMaterial);

/* The numbers of WrMatter (shade/reflection.h). */
typedef struct WR_T(WrKernMatter) {
    REAL kd, ks, colour[3], shininess, scale, alpha, ior, f0, metal, a, b, mean, again;
    REAL least; /* a fainter highlight of facets is omitted; relative to the lamp's light */
    REAL albedo[WR_ALBEDO_TERMS];
} WR_T(WrKernMatter);

/* A solid texture: frequencies and rings per kernel unit; octaves 0: no noise. faded: averaged over pixels.
   height: of bumps, kernel units. mean, variance, fading: of an octave. */
typedef struct WR_T(WrKernGrain) {
    WrSolidTextureKind kind;
    WrSolidTextureAxis axis;
    WrSolidTextureNoise noise;
    bool faded;
    REAL light[3], dark[3], rings, share, amount, edge, height, mean, variance, fading;
    int octaves;
    uint32_t start[WR_SOLID_TEXTURE_OCTAVES]; /* start of the hash chain */
    REAL frequency[WR_SOLID_TEXTURE_OCTAVES], amplitude[WR_SOLID_TEXTURE_OCTAVES],
        offset[WR_SOLID_TEXTURE_OCTAVES][3];
} WR_T(WrKernGrain);
typedef void (*WR_T(WrLookKernel))(const WR_T(WrLook) * look, WR_T(WrStrip) * strip);
typedef void (*WR_T(WrReflectKernel))(const WR_T(WrKernLight) * light,
                                      const WR_T(WrKernMatter) * matter, WrReflectSpread how,
                                      WR_T(WrStrip) * strip);

/* Parameters of environment light (shade/environment_brdf.h, shade/environment_map.h). */
typedef struct WR_T(WrKernSurround) {
    REAL form[3][WR_FORM_TERMS]; /* E / pi as a function of n', along the object's axes */
    REAL kd, colour[3], mean;
    REAL matt[WR_ALBEDO_TERMS], again[WR_ALBEDO_TERMS];
} WR_T(WrKernSurround);
/* Parameters of the mirrored environment. */
typedef struct WR_T(WrKernMirror) {
    REAL axes[9]; /* row-major: the object's axes -> the picture's directions */
    REAL strength;
    REAL own[WR_ALBEDO_TERMS], white[WR_ALBEDO_TERMS];
    const float *rgba; /* of WrEnvLookup, from the first texel of its first row; NULL: one colour */
    int pitch, width, height;
    REAL even[3];
} WR_T(WrKernMirror);
/* The numbers of WrSvbrdf (shade/svbrdf.h), and the mirrored environment at each blur
   level. */
typedef struct WR_T(WrKernVary) {
    bool metals;      /* metal has no diffuse light */
    bool again_twice; /* `twice` and `mean` are not 0 */
    bool alike;       /* metalness is constant: own[0], white[0] belong to it */
    REAL mean[WR_SVBRDF_STEPS], again[WR_SVBRDF_STEPS];
    REAL albedo[WR_SVBRDF_STEPS][WR_SVBRDF_TERMS], matt[WR_SVBRDF_STEPS][WR_SVBRDF_TERMS];
    REAL twice[WR_SVBRDF_STEPS][WR_SVBRDF_TERMS];
    REAL own[2][WR_SVBRDF_STEPS][WR_SVBRDF_TERMS], white[2][WR_SVBRDF_STEPS][WR_SVBRDF_TERMS];
    WrKernMipLevel rung[WR_SVBRDF_RUNGS];
} WR_T(WrKernVary);
/* The table's horizons (field/horizon.h) and ambient occlusion (render/textures/ambient_occlusion.h). */
typedef struct WR_T(WrKernHorizon) {
    const float *slope, *open; /* pictures of width + 1 by height + 1 */
    int width, height, directions;
    REAL ru, rv;   /* replication */
    REAL relief;   /* height of a table unit, kernel units */
    REAL steepest; /* over all directions, table units per texel */
} WR_T(WrKernHorizon);
typedef void (*WR_T(WrEnvironmentMapKernel))(const WR_T(WrKernSurround) * how,
                                             WR_T(WrStrip) * strip);

typedef void (*WR_T(WrShadeKernel))(const WR_T(WrRays) * rays, const WR_T(WrKernLight) * light,
                                    const WR_T(WrKernShine) * shine,
                                    const WR_T(WrKernMaterial) * material, WR_T(WrStrip) * strip);

typedef int (*WR_T(WrHitKernel))(const WR_T(WrRays) * rays, const SHAPE *shape, REAL gx, REAL gy,
                                 int count, WR_T(WrStrip) * strip);
/* Hits of arbitrary samples: strip->x, y [count], which are compacted with the hits. */
typedef int (*WR_T(WrHitAtKernel))(const WR_T(WrRays) * rays, const SHAPE *shape, int count,
                                   WR_T(WrStrip) * strip);

/* A surface with closed-form intersection whose frame follows from the hit point `p`, on the cone relative to
   its tip: u and v are computed only where something is fetched there. */
typedef struct WR_T(WrRound) {
    WR_T(WrHitKernel) hit; /* fills index, s, p of the hits and returns their number */
    WR_T(WrHitAtKernel) hit_at;
    /* These read p; call them in this order, the last one always. */
    void (*params)(const SHAPE *shape, WR_T(WrStrip) * strip);   /* u, v */
    void (*tangents)(const SHAPE *shape, WR_T(WrStrip) * strip); /* Pu, Pv, |N| */
    void (*normals)(const SHAPE *shape, WR_T(WrStrip) * strip);  /* P, overwriting p, and n */
} WR_T(WrRound);

typedef struct WR_T(WrKernels) {
    const char *name; /* "v3" */
    bool exact;       /* same bits as "ref" */

    /* Closed-form visibility of `count` neighbouring samples from (gx, gy): fills index, u, v of the hits and
       returns their number. */
    int (*hit_quad)(const WR_T(WrRays) * rays, const WR_T(WrQuad) * quad, REAL gx, REAL gy,
                    int count, WR_T(WrStrip) * strip);
    int (*hit_quad_at)(const WR_T(WrRays) * rays, const WR_T(WrQuad) * quad, int count,
                       WR_T(WrStrip) * strip);
    WR_T(WrRound) round[WR_INVERSIONS]; /* zeros if a surface has no such intersection */
    /* Draws the triangle's nearest samples into a tile [rows][walk->pitch], with WR_WALK_PAD samples of padding.
       NULL in double precision. */
    void (*cover)(const WrWalk *walk, float *close, float *u, float *v);
    /* The covered samples of a row from (gx, gy) on: index, u, v, x, y. */
    int (*covered)(const float *close, const float *u, const float *v, REAL gx, REAL gy, int count,
                   WR_T(WrStrip) * strip);
    /* Newton's method from the start values in u, v of the samples at x, y: solves P(u,v) = q + s d by 3 x 3
       steps, at most `reach` in u and v, until a step is shorter than `enough` in u and v or the `last`; keeps
       the start value if it finds no better one. Leaves P, Pu, Pv there, for `frame`; in rx, ry the point of the
       last evaluation; wx 1 if a last step was taken from there, else 0. */
    void (*polish[WR_SURFACE_COUNT])(const WR_T(WrRays) * rays, const SHAPE *shape,
                                     const WR_T(WrNewton) * how, WR_T(WrStrip) * strip);
    /* The samples of a row from (gx, gy) on that are in the uv cache (uv_cache.h): index, u, v, wx, x, y. */
    int (*recall)(const float *u, const float *v, REAL gx, REAL gy, int count,
                  WR_T(WrStrip) * strip);
    /* Restores the result of `polish` from its rx, ry, wx, passed in u, v, wx, and x, y, with the same bits. */
    void (*resume[WR_SURFACE_COUNT])(const WR_T(WrRays) * rays, const SHAPE *shape,
                                     const WR_T(WrNewton) * how, WR_T(WrStrip) * strip);
    /* Hits of the rays of x, y on the triangles whose numbers are in u: P, n, |N| = 1; mapped: u, v; sloped: in
       Pu, Pv the vectors that make the normal formulas exact there (kern_triangle_body.h).
       smooth: normals are interpolated, else the first corner's. */
    void (*meet)(const WR_T(WrRays) * rays, const WrTriangleLook *look, bool smooth, bool mapped,
                 bool sloped, WR_T(WrStrip) * strip);
    /* Points only, for meshes. */
    void (*points[WR_SURFACE_COUNT])(const SHAPE *shape, int count, const REAL *u, const REAL *v,
                                     REAL *x, REAL *y, REAL *z);
    /* n and |N| at P, Pu, Pv, u, v as `polish` left them. */
    void (*frame[WR_SURFACE_COUNT])(const SHAPE *shape, WR_T(WrStrip) * strip);
    /* P, Pu, Pv, n, |N|; and n_u, n_v. */
    void (*geometry[WR_SURFACE_COUNT])(const SHAPE *shape, int face, WR_T(WrStrip) * strip);
    void (*curvature[WR_SURFACE_COUNT])(const SHAPE *shape, int face, WR_T(WrStrip) * strip);

    /* F, Fu, Fv of the table. */
    const WR_T(WrLookKernel) * look; /* [wr_scheme_count] */
    /* The footprint of one pixel, `pixel` samples wide, at x, y; after geometry. */
    void (*footprint)(const WR_T(WrRays) * rays, const WR_T(WrLook) * look, REAL pixel,
                      WR_T(WrStrip) * strip);
    /* That footprint, from the vectors that `meet` left in Pu, Pv. */
    void (*footprint_met)(const WR_T(WrRays) * rays, const WR_T(WrLook) * look, REAL pixel,
                          WR_T(WrStrip) * strip);
    /* Level, longer side and number of fetches, from the footprint. */
    void (*spread)(const WR_T(WrLook) * look, bool anisotropic, WR_T(WrStrip) * strip);
    /* F, Fu, Fv and, with moments, suu, suv, svv from the pyramid at u, v and level. */
    void (*look_pyramid)(const WR_T(WrLook) * look, bool moments, WR_T(WrStrip) * strip);
    /* n' from n and the slopes, turned to the viewer's side. */
    void (*bump[WR_BUMP_COUNT])(const WR_T(WrRays) * rays, WR_T(WrStrip) * strip);
    /* As bump[WR_BUMP_BLINN], for a round surface from n, without its tangents; NULL: not available, as in exact
       sets, because the bits differ. */
    void (*bend[WR_INVERSIONS])(const WR_T(WrRays) * rays, const SHAPE *shape,
                                WR_T(WrStrip) * strip);
    /* see, sef, sff from suu, suv, svv; after bump. unit_tangents: slopes are angles for any |Pu|, |Pv|
       (invariant). */
    void (*widen)(bool unit_tangents, WR_T(WrStrip) * strip);

    void (*view)(const WR_T(WrRays) * rays, WR_T(WrStrip) * strip);
    void (*begin)(REAL ambient, WR_T(WrStrip) * strip);
    void (*colour)(const WrColourLook *look, WR_T(WrStrip) * strip); /* after begin */
    /* C from its pyramid at u, v and level. */
    void (*colour_pyramid)(const WR_T(WrLook) * look, WR_T(WrStrip) * strip);
    /* C times the solid texture at P; over: `colour` has filled C, else it is 1. rays: for faded ones; with x,
       y. */
    void (*grain)(const WR_T(WrRays) * rays, const WR_T(WrKernGrain) * grain, bool over,
                  WR_T(WrStrip) * strip);
    /* n' bent further by the texture's height at P; after bump. */
    void (*grain_bump)(const WR_T(WrRays) * rays, const WR_T(WrKernGrain) * grain,
                       WR_T(WrStrip) * strip);
    /* rough from low to high by the solid texture at P. */
    void (*grain_rough)(const WR_T(WrRays) * rays, const WR_T(WrKernGrain) * grain, REAL low,
                        REAL high, WR_T(WrStrip) * strip);
    void (*light)(const WR_T(WrKernLight) * light, WR_T(WrStrip) * strip);
    void (*diffuse)(const WR_T(WrKernLight) * light, REAL kd, WR_T(WrStrip) * strip);
    void (*specular)(const WR_T(WrKernLight) * light, REAL ks, REAL shininess, bool gate,
                     WR_T(WrStrip) * strip);
    /* The highlight widened by see, sef, sff: by the whole covariance, or by its mean. */
    void (*specular_lean)(const WR_T(WrKernLight) * light, const WR_T(WrKernShine) * shine,
                          WR_T(WrStrip) * strip);
    void (*specular_toksvig)(const WR_T(WrKernLight) * light, const WR_T(WrKernShine) * shine,
                             WR_T(WrStrip) * strip);
    /* Diffuse light and highlight of other models, as published or energy-conserving; NULL: Blinn-Phong's uses
       the functions above. */
    const WR_T(WrReflectKernel) (*reflect)[WR_ENERGY_COUNT]; /* [wr_reflect_count] */
    /* Tests of a run, after `light` and `view`: does every n' face the viewer; has no slope (suu, suv, svv) a
       spread? */
    bool (*faces)(const WR_T(WrStrip) * strip);
    bool (*gathered)(const WR_T(WrStrip) * strip);
    /* Least n'.v, largest n'.axis, least v.v0, least l.l0; NaNs are ignored. */
    void (*survey)(const REAL axis[3], const REAL v0[3], const REAL l0[3],
                   const WR_T(WrStrip) * strip, REAL out[4]);
    /* Lamps, and environment light, by rough and metal of each sample; the mirrored environment also as wide as
       slopes spread. */
    void (*reflect_vary)(const WR_T(WrKernLight) * light, const WR_T(WrKernMatter) * matter,
                         const WR_T(WrKernVary) * vary, int model, bool kept, WrReflectSpread how,
                         WR_T(WrStrip) * strip);
    void (*surround_vary)(const WR_T(WrKernSurround) * how, const WR_T(WrKernVary) * vary,
                          WR_T(WrStrip) * strip);
    void (*mirror_vary)(const WR_T(WrKernMirror) * how, const WR_T(WrKernVary) * vary, bool spread,
                        WR_T(WrStrip) * strip);
    /* Diffuse environment light; after `view` unless it is Lambert's: [depends on n'; else one colour] [0:
       Lambert's; 1: by matt; 2: with interreflection]. */
    WR_T(WrEnvironmentMapKernel) surround[2][3];
    /* Reflection of the environment in the mirrored direction: from the picture, or of one colour. */
    void (*mirror)(const WR_T(WrKernMirror) * how, WR_T(WrStrip) * strip);
    void (*mirror_even)(const WR_T(WrKernMirror) * how, WR_T(WrStrip) * strip);
    /* Visibility of a lamp above the relief's horizon at each sample, 0..1, from u, v, P, Pu, Pv, n and n'. */
    WrSeen (*shadow)(const WR_T(WrKernLight) * light, const WR_T(WrKernHorizon) * horizon,
                     const WR_T(WrStrip) * strip, REAL share[WR_SPAN]);
    /* Unoccluded share of the sky at u and v. */
    void (*open)(const WR_T(WrKernHorizon) * horizon, const WR_T(WrStrip) * strip,
                 REAL share[WR_SPAN]);
    /* Scales the light added to `to` since `before` (NULL: since 0) by the shares. */
    void (*veil)(const REAL share[WR_SPAN], const REAL *before, int count, REAL *to);
    /* Colours the highlights so far by the surface's colour, to the share t; after all lights. */
    void (*tint)(REAL t, WR_T(WrStrip) * strip);
    /* begin, view, light, diffuse, specular and finish of a single light in one pass, from n' and P: [the light
       is near] [the eye is near] [it has a highlight] [C is a picture's, filled by `colour`]. NULL in double
       precision. */
    WR_T(WrShadeKernel) shade[2][2][2][2];
    void (*finish)(const REAL colour[3], WR_T(WrStrip) * strip);
    /* u0, u1, v0, v1 of the strip. */
    void (*reach)(const WR_T(WrStrip) * strip, double box[4]);
    /* behind: true if the light is certainly behind every step-th sample, with n' = n. behind_bumped: with
       Blinn's n' for any slopes up to these, either sign. */
    bool (*behind)(const WR_T(WrRays) * rays, const WR_T(WrKernLight) * light, int step,
                   const WR_T(WrStrip) * strip);
    bool (*behind_bumped)(const WR_T(WrRays) * rays, const WR_T(WrKernLight) * light,
                          const REAL steepest[2], int step, const WR_T(WrStrip) * strip);
    /* All of the light where all lights are behind; pictured: `colour` has filled C. */
    void (*ambient)(const WR_T(WrKernMaterial) * material, bool pictured, WR_T(WrStrip) * strip);
    /* codes: finished colours as opaque 8-bit codes (pixel_encode.h), out [count]. codes_over: premultiplied
       ones, [count][4], over a background. Non-finite numbers count as 0; returns how many there were. */
    int (*codes)(const uint32_t *bins, const WR_T(WrStrip) * strip, uint32_t *out);
    int (*codes_over)(const uint32_t *bins, const float background[3], int count, const float *rgba,
                      uint32_t *out);
    /* Tone-mapped colours, each over its own background, [count][4], as 8-bit codes; returns the number of
       non-finite values. */
    int (*codes_behind)(const uint32_t *bins, const WrToneCurve *tone, const float *behind,
                        int count, const float *rgba, uint32_t *out);

    /* For `count` pixels the means predicted from one sample each and its neighbours, and their possible error;
       row[2] holds the samples, RGBA, with two more on either side, the others the rows above and below. weight:
       of second differences; slope: of first ones, in `off`. If a neighbour differs in coverage, the error is
       1e9. NULL in double precision. */
    void (*smooth)(const float *const row[5], int count, float weight, float slope, float *rgba,
                   float *off);

    /* Texels along each of `count` pixels, from u and v of the row above, the pixels with one more on either
       side, and the row below; `of`: texels along all of u and all of v. NULL in double precision. */
    void (*texels)(const float *const row[3], int count, const float of[2], float *out);

    /* Bounds over the pixel of side `pixel` samples around x, y (dials.h, refine=bound): the pixel's area on the
       surface; the change of its slopes and its normal; the change of a light's share. */
    void (*bound_sphere)(const WR_T(WrRays) * rays, const SHAPE *shape, REAL pixel,
                         WR_T(WrStrip) * strip);
    void (*bound_quad)(const WR_T(WrRays) * rays, const WR_T(WrQuad) * quad, REAL pixel,
                       WR_T(WrStrip) * strip);
    void (*bound_slopes)(const WR_T(WrLook) * look, WR_T(WrStrip) * strip);
    void (*bound_normal)(bool sphere, bool bumped, WR_T(WrStrip) * strip);
    void (*bound_light)(const WR_T(WrRays) * rays, const WR_T(WrKernLight) * light,
                        const WR_T(WrKernShine) * shine, REAL kd, WR_T(WrStrip) * strip);
} WR_T(WrKernels);
