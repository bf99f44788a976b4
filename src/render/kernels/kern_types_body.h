/* kern_types_body.h - strips, rays, look-ups and the table of kernels, written once for single precision and
   once for double. Part of kern.h, which defines REAL, SHAPE and WR_T(name) (WrStrip, WrStripd) before
   each turn. A header without a guard, by intention. */

/* The samples of one strip. Members are filled stage by stage; count is how many are in use. */
typedef struct WR_T(WrStrip) {
    int count;
    _Alignas(64) int index[WR_SPAN]; /* which sample of the row this is, ascending */
    _Alignas(64) REAL s[WR_SPAN];    /* ray parameter (closed forms) */
    REAL u[WR_SPAN], v[WR_SPAN];     /* patch parameters, 0..1 */
    int triangle[WR_SPAN]; /* of a mesh; only where a normal map is turned by its frames */
    REAL px[WR_SPAN], py[WR_SPAN], pz[WR_SPAN]; /* P */
    REAL pux[WR_SPAN], puy[WR_SPAN], puz[WR_SPAN];
    REAL pvx[WR_SPAN], pvy[WR_SPAN], pvz[WR_SPAN];
    REAL nx[WR_SPAN], ny[WR_SPAN], nz[WR_SPAN];    /* n, unit */
    REAL n_len[WR_SPAN];                           /* |N| */
    REAL nux[WR_SPAN], nuy[WR_SPAN], nuz[WR_SPAN]; /* dn/du; only where curvature ran */
    REAL nvx[WR_SPAN], nvy[WR_SPAN], nvz[WR_SPAN];
    REAL tu[WR_SPAN], tv[WR_SPAN];              /* place in the table, 0..1 */
    REAL inside_u[WR_SPAN], inside_v[WR_SPAN];  /* 1; 0 beyond the end of a clamped axis */
    int at[WR_SPAN];                            /* first tap in the copies */
    REAL ta[WR_SPAN], tb[WR_SPAN];              /* fractions past it */
    REAL top[4 * WR_SPAN], low[4 * WR_SPAN];    /* taps of the upper and the lower row */
    REAL f[WR_SPAN], fu[WR_SPAN], fv[WR_SPAN];  /* height and replication included */
    REAL bx[WR_SPAN], by[WR_SPAN], bz[WR_SPAN]; /* n', unit, towards the viewer's side */
    REAL vx[WR_SPAN], vy[WR_SPAN], vz[WR_SPAN]; /* unit, towards the viewer */
    REAL lx[WR_SPAN], ly[WR_SPAN], lz[WR_SPAN]; /* unit, towards the light at hand */
    REAL n_dot_l[WR_SPAN];
    REAL rough[WR_SPAN], metal[WR_SPAN];        /* only where they are not the same everywhere */
    REAL dr[WR_SPAN], dg[WR_SPAN], db[WR_SPAN]; /* ambient and diffuse sums */
    REAL sr[WR_SPAN], sg[WR_SPAN], sb[WR_SPAN]; /* specular sums */
    REAL cr[WR_SPAN], cg[WR_SPAN], cb[WR_SPAN]; /* C(u,v), then the finished colour */
    /* Place in the sample grid; given to the scattered hits and to polish, kept with what hit. */
    REAL x[WR_SPAN], y[WR_SPAN];
    /* The footprint: the step in the table, texels, of one pixel to the right and of one down. */
    REAL rx[WR_SPAN], ry[WR_SPAN], wx[WR_SPAN], wy[WR_SPAN];
    REAL level[WR_SPAN];                   /* of the pyramid: 0 .. its last, fractions between */
    REAL long_u[WR_SPAN], long_v[WR_SPAN]; /* the longer side of the footprint, in u and v */
    int taps[WR_SPAN];                     /* along it; 1..WR_TAPS_MOST */
    /* Covariance of the slopes within the footprint, as fu, fv are measured. */
    REAL suu[WR_SPAN], suv[WR_SPAN], svv[WR_SPAN];
    /* The same in the plane across n', as tangents of angles: along e, across, and mixed. */
    REAL ex[WR_SPAN], ey[WR_SPAN], ez[WR_SPAN];
    REAL see[WR_SPAN], sef[WR_SPAN], sff[WR_SPAN];
    bool gathered; /* slopes spread at no sample: all of these are 0 */
    /* Over the pixel: bounds of u, v; of |P - P at the centre|; of the change of n, of the slopes' vector,
       of n'; and of the intensity. Infinite: none is known. */
    REAL u_low[WR_SPAN], u_high[WR_SPAN], v_low[WR_SPAN], v_high[WR_SPAN];
    REAL reach[WR_SPAN], turn[WR_SPAN];
    REAL fu_low[WR_SPAN], fu_high[WR_SPAN], fv_low[WR_SPAN], fv_high[WR_SPAN];
    REAL swing[WR_SPAN], bound[WR_SPAN];
} WR_T(WrStrip);

/* The ray of sample (gx, gy) of the frame's sample grid: q + s d, with q = q0 + gx qx + gy qy and d
   alike. q lies in the plane through the object's centre that faces the camera, so that its size is
   the object's and nothing cancels however far the eye is; with the eye at the object it lies at the eye. */
typedef struct WR_T(WrRays) {
    REAL q0[3], qx[3], qy[3];
    REAL d0[3], dx[3], dy[3];
    REAL s_min; /* nearer than this is behind the near plane */
    bool perspective;
    REAL eye[3];    /* perspective */
    REAL toward[3]; /* orthographic: unit vector towards the viewer */
} WR_T(WrRays);

/* A flat parallelogram with orthogonal edges: plane, or a face of the cube. */
typedef struct WR_T(WrQuad) {
    REAL origin[3], normal[3];
    REAL eu[3], ev[3];   /* Pu / |Pu|^2, Pv / |Pv|^2: dot products give u, v */
    REAL u0, u1, v0, v1; /* what of u and v is on it: 0..1, a little more where another joins on */
    REAL least, most;    /* u and v are brought to within them: 0 and 1, unless it is endless */
} WR_T(WrQuad);

/* Where and how heights are looked up. Contiguous copies with an apron (height_copies.h). */
typedef struct WR_T(WrLook) {
    const REAL *heights;  /* F, or spline coefficients; texel (i,j) at [(j + A) pitch + i + A] */
    const REAL *gradient; /* central differences dF/du, dF/dv interleaved, same layout */
    int pitch;            /* texels a row */
    int width, height;
    double ru, rv; /* replication */
    bool periodic_u, periodic_v;
    bool wide;                      /* reduce r u in double (E10) */
    REAL scale_f, scale_u, scale_v; /* height; height * ru; height * rv */
    REAL
        reach; /* footprints are no longer, texels: beyond it other faces' heights lie; or 0: as they are */
    const WrPyramid *pyramid; /* means and covariances of the slopes (slope_pyramid.h); or NULL */
    const WrPyramid *range;   /* least and largest slopes; or NULL */
} WR_T(WrLook);

typedef struct WR_T(WrKernLight) {
    bool point;
    REAL where[3]; /* unit direction towards it, or position */
    REAL rgb[3];   /* colour * strength */
    double radius; /* of a round lamp, radians */
    bool shadow;   /* objects hide it */
} WR_T(WrKernLight);

/* ks, s and the gate of a highlight. */
typedef struct WR_T(WrKernShine) {
    REAL ks, shininess;
    bool gate;
} WR_T(WrKernShine);

/* What a material and its ambient light come to. */
typedef struct WR_T(WrKernMaterial) {
    REAL ambient, kd;
    REAL rgb[3]; /* its colour */
} WR_T(WrKernMaterial);

/* WrMatter's numbers (shade/reflection.h). */
typedef struct WR_T(WrKernMatter) {
    REAL kd, ks, colour[3], shininess, scale, alpha, ior, f0, metal, a, b, mean, again;
    REAL least; /* a fainter highlight of facets is none; of a lamp's light */
    REAL albedo[WR_ALBEDO_TERMS];
} WR_T(WrKernMatter);

/* A solid texture as kernels want it: frequencies and rings a kernel unit; octaves 0: no noise. faded: over what pixels
   hold. height: of bumps, kernel units. mean, variance, fading: of an octave. */
typedef struct WR_T(WrKernGrain) {
    WrSolidTextureKind kind;
    WrSolidTextureAxis axis;
    WrSolidTextureNoise noise;
    bool faded;
    REAL light[3], dark[3], rings, share, amount, edge, height, mean, variance, fading;
    int octaves;
    uint32_t start[WR_SOLID_TEXTURE_OCTAVES]; /* of the chain of hashes */
    REAL frequency[WR_SOLID_TEXTURE_OCTAVES], amplitude[WR_SOLID_TEXTURE_OCTAVES],
        offset[WR_SOLID_TEXTURE_OCTAVES][3];
} WR_T(WrKernGrain);
typedef void (*WR_T(WrReflectKernel))(const WR_T(WrKernLight) * light,
                                      const WR_T(WrKernMatter) * matter, WrReflectSpread how,
                                      WR_T(WrStrip) * strip);

/* What surroundings do to a strip (shade/environment_brdf.h, shade/environment_map.h). */
typedef struct WR_T(WrKernSurround) {
    REAL form[3][WR_FORM_TERMS]; /* E / pi by n', along the object's axes */
    REAL kd, colour[3], mean;
    REAL matt[WR_ALBEDO_TERMS], again[WR_ALBEDO_TERMS];
} WR_T(WrKernSurround);
/* The same of what is reflected about the mirrored direction. */
typedef struct WR_T(WrKernMirror) {
    REAL axes[9]; /* row-major: the object's axes -> the picture's directions */
    REAL strength;
    REAL own[WR_ALBEDO_TERMS], white[WR_ALBEDO_TERMS];
    const float *rgba; /* WrEnvLookup's, from its first row's first texel; NULL: of one colour */
    int pitch, width, height;
    REAL even[3];
} WR_T(WrKernMirror);
/* WrTexturedReflection's numbers (shade/textured_reflection.h), and what is mirrored, rung by rung. */
typedef struct WR_T(WrKernVary) {
    bool metals;      /* metal has no diffuse light */
    bool again_twice; /* `twice` and `mean` are not 0 */
    bool alike;       /* metalness is the same everywhere: own[0], white[0] are of it */
    REAL mean[WR_TEXTURED_REFLECTION_STEPS], again[WR_TEXTURED_REFLECTION_STEPS];
    REAL albedo[WR_TEXTURED_REFLECTION_STEPS][WR_TEXTURED_REFLECTION_TERMS],
        matt[WR_TEXTURED_REFLECTION_STEPS][WR_TEXTURED_REFLECTION_TERMS];
    REAL twice[WR_TEXTURED_REFLECTION_STEPS][WR_TEXTURED_REFLECTION_TERMS];
    REAL own[2][WR_TEXTURED_REFLECTION_STEPS][WR_TEXTURED_REFLECTION_TERMS],
        white[2][WR_TEXTURED_REFLECTION_STEPS][WR_TEXTURED_REFLECTION_TERMS];
    WrKernRung rung[WR_TEXTURED_REFLECTION_RUNGS];
} WR_T(WrKernVary);
/* The table's horizons (field/horizon.h) as kernels look them up, and how open it is (render/textures/ambient_occlusion.h). */
typedef struct WR_T(WrKernHorizon) {
    const float *slope, *open; /* pictures of width + 1 by height + 1 */
    int width, height, directions;
    REAL ru, rv;   /* replication */
    REAL relief;   /* of a table unit, kernel units */
    REAL steepest; /* of all directions, table units a texel */
} WR_T(WrKernHorizon);
typedef void (*WR_T(WrEnvironmentMapKernel))(const WR_T(WrKernSurround) * how,
                                             WR_T(WrStrip) * strip);

typedef void (*WR_T(WrShadeKernel))(const WR_T(WrRays) * rays, const WR_T(WrKernLight) * light,
                                    const WR_T(WrKernShine) * shine,
                                    const WR_T(WrKernMaterial) * material, WR_T(WrStrip) * strip);

typedef int (*WR_T(WrHitKernel))(const WR_T(WrRays) * rays, const SHAPE *shape, REAL gx, REAL gy,
                                 int count, WR_T(WrStrip) * strip);
/* The same for samples anywhere: strip->x, y [count], which move with the hits. */
typedef int (*WR_T(WrHitAtKernel))(const WR_T(WrRays) * rays, const SHAPE *shape, int count,
                                   WR_T(WrStrip) * strip);

/* A surface that rays meet in closed form and whose frame follows from the point that they meet (`p`, of the cone
   from its tip): u and v are worked out only where something is read there. */
typedef struct WR_T(WrRound) {
    WR_T(WrHitKernel) hit; /* fills index, s, p of those that hit and returns how many */
    WR_T(WrHitAtKernel) hit_at;
    /* These read p; in this order, the last always. */
    void (*params)(const SHAPE *shape, WR_T(WrStrip) * strip);   /* u, v */
    void (*tangents)(const SHAPE *shape, WR_T(WrStrip) * strip); /* Pu, Pv, |N| */
    void (*normals)(const SHAPE *shape, WR_T(WrStrip) * strip);  /* P in the place of p, and n */
} WR_T(WrRound);

typedef struct WR_T(WrKernels) {
    const char *name; /* "v3" */
    bool exact;       /* same bits as "ref" */

    /* Visibility in closed form for `count` neighbouring samples from (gx, gy): fills index, u, v of
       those that hit and returns how many. */
    int (*hit_quad)(const WR_T(WrRays) * rays, const WR_T(WrQuad) * quad, REAL gx, REAL gy,
                    int count, WR_T(WrStrip) * strip);
    int (*hit_quad_at)(const WR_T(WrRays) * rays, const WR_T(WrQuad) * quad, int count,
                       WR_T(WrStrip) * strip);
    WR_T(WrRound) round[WR_INVERSIONS]; /* zeros where rays meet a surface otherwise */
    /* The triangle's nearest samples into a tile [rows][walk->pitch] and WR_WALK_PAD more. NULL in double precision. */
    void (*cover)(const WrWalk *walk, float *close, float *u, float *v);
    /* The samples of a row from (gx, gy) on that something covers: index, u, v, x, y. */
    int (*covered)(const float *close, const float *u, const float *v, REAL gx, REAL gy, int count,
                   WR_T(WrStrip) * strip);
    /* Newton's method from the guesses in u, v of the samples at x, y: solves P(u,v) = q + s d by
       3 x 3 steps, no longer than `reach` in u and v, until a step is shorter than `enough` in u and v or the
       `last`; keeps the guess where it does not improve. Leaves P, Pu, Pv there, for `frame`; in rx, ry where the
       surface was evaluated last; wx 1 where a last step was left from there, else 0. */
    void (*polish[WR_SURFACE_COUNT])(const WR_T(WrRays) * rays, const SHAPE *shape,
                                     const WR_T(WrNewton) * how, WR_T(WrStrip) * strip);
    /* The samples of a row from (gx, gy) on that were noted (uv_cache.h): index, u, v, wx, x, y. */
    int (*recall)(const float *u, const float *v, REAL gx, REAL gy, int count,
                  WR_T(WrStrip) * strip);
    /* From u, v, wx and x, y to what `polish` left when it had rx, ry, wx, with the same bits. */
    void (*resume[WR_SURFACE_COUNT])(const WR_T(WrRays) * rays, const SHAPE *shape,
                                     const WR_T(WrNewton) * how, WR_T(WrStrip) * strip);
    /* Where the rays of x, y meet the triangles whose numbers stand in u: P, n, |N| = 1; mapped: u, v; sloped: in the
       place of Pu, Pv what makes the normal formulas exact there (kern_triangle_body.h).
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
    void (*look[WR_SCHEME_COUNT])(const WR_T(WrLook) * look, WR_T(WrStrip) * strip);
    /* The footprint of one pixel, `pixel` samples wide, at x, y; after geometry. */
    void (*footprint)(const WR_T(WrRays) * rays, const WR_T(WrLook) * look, REAL pixel,
                      WR_T(WrStrip) * strip);
    /* The same of what `meet` left in the place of Pu, Pv. */
    void (*footprint_met)(const WR_T(WrRays) * rays, const WR_T(WrLook) * look, REAL pixel,
                          WR_T(WrStrip) * strip);
    /* Level, longer side and taps from the footprint. */
    void (*spread)(const WR_T(WrLook) * look, bool anisotropic, WR_T(WrStrip) * strip);
    /* F, Fu, Fv and, with moments, suu, suv, svv from the pyramid at u, v and level. */
    void (*look_pyramid)(const WR_T(WrLook) * look, bool moments, WR_T(WrStrip) * strip);
    /* n' from n and the slopes, turned to the viewer's side. */
    void (*bump[WR_BUMP_COUNT])(const WR_T(WrRays) * rays, WR_T(WrStrip) * strip);
    /* The same as bump[WR_BUMP_BLINN] of a round surface from n, without its tangents; NULL: there is none, as in exact
       sets, for the bits differ. */
    void (*bend[WR_INVERSIONS])(const WR_T(WrRays) * rays, const SHAPE *shape,
                                WR_T(WrStrip) * strip);
    /* see, sef, sff from suu, suv, svv; after bump. unit_tangents: slopes are angles whatever |Pu|, |Pv|
       are (invariant). */
    void (*widen)(bool unit_tangents, WR_T(WrStrip) * strip);

    void (*view)(const WR_T(WrRays) * rays, WR_T(WrStrip) * strip);
    void (*begin)(REAL ambient, WR_T(WrStrip) * strip);
    void (*colour)(const WrColourLook *look, WR_T(WrStrip) * strip); /* after begin */
    /* C from its pyramid at u, v and level. */
    void (*colour_pyramid)(const WR_T(WrLook) * look, WR_T(WrStrip) * strip);
    /* C times the solid texture at P; over: `colour` has brought C, else it is 1. rays: of faded ones; with x, y. */
    void (*grain)(const WR_T(WrRays) * rays, const WR_T(WrKernGrain) * grain, bool over,
                  WR_T(WrStrip) * strip);
    /* n' once more from what its height is at P; after bump. */
    void (*grain_bump)(const WR_T(WrRays) * rays, const WR_T(WrKernGrain) * grain,
                       WR_T(WrStrip) * strip);
    /* rough from low to high by the solid texture at P. */
    void (*grain_rough)(const WR_T(WrRays) * rays, const WR_T(WrKernGrain) * grain, REAL low,
                        REAL high, WR_T(WrStrip) * strip);
    void (*light)(const WR_T(WrKernLight) * light, WR_T(WrStrip) * strip);
    void (*diffuse)(const WR_T(WrKernLight) * light, REAL kd, WR_T(WrStrip) * strip);
    void (*specular)(const WR_T(WrKernLight) * light, REAL ks, REAL shininess, bool gate,
                     WR_T(WrStrip) * strip);
    /* The highlight widened by see, sef, sff: along every direction, or by their mean. */
    void (*specular_lean)(const WR_T(WrKernLight) * light, const WR_T(WrKernShine) * shine,
                          WR_T(WrStrip) * strip);
    void (*specular_toksvig)(const WR_T(WrKernLight) * light, const WR_T(WrKernShine) * shine,
                             WR_T(WrStrip) * strip);
    /* Diffuse light and highlight of other models, as published or kept; NULL: Blinn-Phong's is made of the above. */
    WR_T(WrReflectKernel) reflect[WR_REFLECT_COUNT][WR_ENERGY_COUNT];
    /* Of a run, after `light` and `view`: is n' of all seen from its front; do slopes (suu, suv, svv) spread nowhere? */
    bool (*faces)(const WR_T(WrStrip) * strip);
    bool (*gathered)(const WR_T(WrStrip) * strip);
    /* Least n'.v, most n'.axis, least v.v0, least l.l0; nothing that is not a number. */
    void (*survey)(const REAL axis[3], const REAL v0[3], const REAL l0[3],
                   const WR_T(WrStrip) * strip, REAL out[4]);
    /* The same, and of surroundings, by rough and metal of each sample; what is mirrored also as wide as slopes spread. */
    void (*reflect_vary)(const WR_T(WrKernLight) * light, const WR_T(WrKernMatter) * matter,
                         const WR_T(WrKernVary) * vary, WrReflect model, bool kept,
                         WrReflectSpread how, WR_T(WrStrip) * strip);
    void (*surround_vary)(const WR_T(WrKernSurround) * how, const WR_T(WrKernVary) * vary,
                          WR_T(WrStrip) * strip);
    void (*mirror_vary)(const WR_T(WrKernMirror) * how, const WR_T(WrKernVary) * vary, bool spread,
                        WR_T(WrStrip) * strip);
    /* Diffuse light of surroundings; after `view` where it is not Lambert's: [by n', else of one colour] [0: Lambert's;
       1: by matt; 2: and again]. */
    WR_T(WrEnvironmentMapKernel) surround[2][3];
    /* What is reflected of them about the mirrored direction: out of the picture, or of one colour. */
    void (*mirror)(const WR_T(WrKernMirror) * how, WR_T(WrStrip) * strip);
    void (*mirror_even)(const WR_T(WrKernMirror) * how, WR_T(WrStrip) * strip);
    /* What each sample sees of a lamp over the relief's horizon, 0..1, by u, v, P, Pu, Pv, n and n'. */
    WrSeen (*shadow)(const WR_T(WrKernLight) * light, const WR_T(WrKernHorizon) * horizon,
                     const WR_T(WrStrip) * strip, REAL share[WR_SPAN]);
    /* How open the table is at u and v. */
    void (*open)(const WR_T(WrKernHorizon) * horizon, const WR_T(WrStrip) * strip,
                 REAL share[WR_SPAN]);
    /* Of what came to `to` since it was `before`, NULL: 0, those shares are kept. */
    void (*veil)(const REAL share[WR_SPAN], const REAL *before, int count, REAL *to);
    /* Highlights so far in the surface's colour, to the share t; after all lights. */
    void (*tint)(REAL t, WR_T(WrStrip) * strip);
    /* begin, view, light, diffuse, specular and finish of a single light in one pass, from n' and P: [the light is near]
       [the eye is near] [it shines] [C is a picture's, which `colour` has brought]. NULL in double precision. */
    WR_T(WrShadeKernel) shade[2][2][2][2];
    void (*finish)(const REAL colour[3], WR_T(WrStrip) * strip);
    /* u0, u1, v0, v1 of the strip. */
    void (*reach)(const WR_T(WrStrip) * strip, double box[4]);
    /* Is the light for certain behind every step-th sample, n' being n? The same of Blinn's n' whatever slopes it has
       up to these, either sign. */
    bool (*behind)(const WR_T(WrRays) * rays, const WR_T(WrKernLight) * light, int step,
                   const WR_T(WrStrip) * strip);
    bool (*behind_bumped)(const WR_T(WrRays) * rays, const WR_T(WrKernLight) * light,
                          const REAL steepest[2], int step, const WR_T(WrStrip) * strip);
    /* All of the light where all lights are behind; pictured: `colour` has brought C. */
    void (*ambient)(const WR_T(WrKernMaterial) * material, bool pictured, WR_T(WrStrip) * strip);
    /* Finished colours as opaque 8-bit codes (srgb_encode.h), out [count]; of premultiplied ones, [count][4], over a
       background. What is not finite counts as 0; how many numbers were not. */
    int (*codes)(const uint32_t *bins, const WR_T(WrStrip) * strip, uint32_t *out);
    int (*codes_over)(const uint32_t *bins, const float background[3], int count, const float *rgba,
                      uint32_t *out);
    /* The same of colours that are toned, each over its own [count][4]. */
    int (*codes_behind)(const uint32_t *bins, const WrToneCurve *tone, const float *behind,
                        int count, const float *rgba, uint32_t *out);

    /* Of `count` pixels the means that one sample each and its neighbours give, and how far they may be off; row[2] holds
       the samples, RGBA, with two more on either side, the others the rows above and below. weight: of second
       differences; slope: of first ones, in `off`. A pixel with a neighbour of other coverage is off by 1e9. NULL in
       double precision. */
    void (*smooth)(const float *const row[5], int count, float weight, float slope, float *rgba,
                   float *off);

    /* Texels along each of `count` pixels, from u and v of the rows above, of the pixels, with one more on either side,
       and below; all of u and all of v are so many. NULL in double precision. */
    void (*texels)(const float *const row[3], int count, const float of[2], float *out);

    /* Bounds over the pixel of side `pixel` samples about x, y (dials.h, refine=bound): where the pixel
       lies on the surface; how far its slopes and its normal move; what a light adds. */
    void (*bound_sphere)(const WR_T(WrRays) * rays, const SHAPE *shape, REAL pixel,
                         WR_T(WrStrip) * strip);
    void (*bound_quad)(const WR_T(WrRays) * rays, const WR_T(WrQuad) * quad, REAL pixel,
                       WR_T(WrStrip) * strip);
    void (*bound_slopes)(const WR_T(WrLook) * look, WR_T(WrStrip) * strip);
    void (*bound_normal)(bool sphere, bool bumped, WR_T(WrStrip) * strip);
    void (*bound_light)(const WR_T(WrRays) * rays, const WR_T(WrKernLight) * light,
                        const WR_T(WrKernShine) * shine, REAL kd, WR_T(WrStrip) * strip);
} WR_T(WrKernels);
