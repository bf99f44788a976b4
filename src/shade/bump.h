/* bump.h - the bump formulas of the paper: the perturbed normal of P(u,v) from F(u,v).

   This is the definition; every faster form must agree with it. Double precision; N = Pu x Pv is not
   unit; n = N/|N| or its limit where N = 0.

   blinn      N' = N + D,  D = Fu (n x Pv) - Fv (n x Pu)                       Blinn 1978 section 2
              drops the terms in F: accurate while F is small compared with the radii of curvature. The
              angle of rotation has tan(theta) = |D| / |N|, about A = Fv Pu - Fu Pv.
   invariant  N'' = N + D',  D' = a D |N| / |D|,  a = sqrt(Fu^2 + Fv^2)         section 4 tan(theta') =
              a at any scale of the object.
   exact      N' = Pu' x Pv',  Pu' = Pu + Fu n + F n_u,  Pv' = Pv + Fv n + F n_v   the true normal of
              the displaced surface P' = P + F n, with the terms that the paper drops. Computed as Qu x
              Qv + n x (Fu Qv - Fv Qu), Qu = Pu + F n_u, Qv = Pv + F n_v: n x n = 0 drops out. */
#pragma once
#include "base/vec.h"
#include "shade/bump_mode.h"

/* D = Fu (n x Pv) - Fv (n x Pu) = n x (Fu Pv - Fv Pu), in the tangent plane, pointing downhill. */
static inline WrVec3 wr_bump_d(WrVec3 n_unit, WrVec3 pu, WrVec3 pv, double fu, double fv)
{
    return v3_cross(n_unit, v3_sub(v3_scale(pv, fu), v3_scale(pu, fv)));
}

/* A = Fv Pu - Fu Pv: the axis of rotation; |A| = |D|. */
static inline WrVec3 wr_bump_axis(WrVec3 pu, WrVec3 pv, double fu, double fv)
{
    return v3_sub(v3_scale(pu, fv), v3_scale(pv, fu));
}

/* N' in the given mode.
 *
 * n, n_unit     N and its unit (or limiting) direction
 * pu, pv        tangents          n_u, n_v   derivatives of n_unit (exact only)
 * f, fu, fv     scene units, and scene units per unit of u, v: height and replication included; finite
 * Result        not unit; exactly n where Fu = Fv = 0 (exact: where F or n_u and n_v are 0 as well),
 *               bit for bit (HC17). invariant returns N where N or D is 0; exact returns exactly 0
 *               where N' is only rounding error, as at a focal distance (HC12). If N' is beyond
 *               double's range it is divided by a power of two. Never NaN or infinite for finite input,
 *               for any slope or scale (HC09, HC12-HC19). */
WrVec3 wr_bump_normal(WrBumpMode mode, WrVec3 n, WrVec3 n_unit, WrVec3 pu, WrVec3 pv, WrVec3 n_u,
                      WrVec3 n_v, double f, double fu, double fv);

/* N' normalised; n_unit where N' is 0 or not finite. */
WrVec3 wr_bump_unit(WrVec3 n_perturbed, WrVec3 n_unit);

/* The normalised perturbed normal, also correct in limiting cases; arguments as wr_bump_normal.
 *
 * Result        unit; n_unit bit for bit where Fu = Fv = 0, as above, and where N' = 0. invariant: n +
 *               a D/|D| normalised, so that tan(theta') = a also where N = 0; where D = 0 too, its
 *               direction is the limit for tangents at right angles, -Fv Pv where Pu = 0 and -Fu Pu
 *               where Pv = 0. Otherwise wr_bump_normal normalised, but without loss if N' itself would
 *               leave double's range in either direction. */
WrVec3 wr_bump_unit_normal(WrBumpMode mode, WrVec3 n, WrVec3 n_unit, WrVec3 pu, WrVec3 pv,
                           WrVec3 n_u, WrVec3 n_v, double f, double fu, double fv);

/* The angle between N and N' in degrees, atan2(|N x N'|, N.N'), 0..180. */
double wr_bump_tilt_deg(WrVec3 n_unit, WrVec3 n_perturbed_unit);

/* N' of a relief over a normal map. g, b: gradients across n_unit, whose normals are n - g, the map's, and n - b,
 * the relief's. Not unit. With w = sqrt(1 + g.g), the length of the map's surface along g over the base:
 *
 *   slopes      n - (g + b)
 *   reoriented  n (1 - g.b) - (g + w b - g (g.b) / (1 + w))       the rotation that takes n to n - g, of n - b:
 *               Barre-Brisebois and Hill 2012, t (t.u) / t_z - u, multiplied out. Exact if the relief's slopes
 *               are by lengths on the map's surface
 *   surface     n (1 - g.b / w) - (g + w b - g (g.b) / w)         the same of b / w along g. Exact where heights
 *               by u and v rise along the map's normal and that normal turns slowly: terms in its curvature are
 *               dropped, as in `blinn`
 *
 * n - g if b is 0; proportional to n - b if g is 0. It may face away from n. */
WrVec3 wr_bump_combined(WrCombine combine, WrVec3 n_unit, WrVec3 g, WrVec3 b);
