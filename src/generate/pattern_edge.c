#include "base/exactmath.h"
#include "generate/pattern.h"

#include <math.h>

const char *const wr_along_words[] = { WR_ALONGS(WR_WORD) NULL };
const char *const wr_profile_words[] = { WR_PROFILES(WR_WORD) NULL };

WrEdge wr_edge_of(const WrParams *params)
{
    return (WrEdge){ .bevel = wr_param_number(params, "bevel"),
                     .profile = (WrProfile)wr_param_whole(params, "profile") };
}

/* The area under sqrt(1 - s^2) from 0 to s, s in 0..1. */
static double circle_area(double s)
{
    return 0.5 * (s * sqrt(1.0 - s * s) + wr_asin(s));
}

/* The integral of the profile from the edge to t bevels inside, t in 0..1, in bevels.
     round    sqrt(1 - (1 - t)^2)      smooth   3 t^2 - 2 t^3
     chamfer  t                        cove     1 - sqrt(1 - t^2) */
static double profile_area(WrProfile profile, double t)
{
    switch (profile) {
    case WR_PROFILE_ROUND: return 0.25 * WR_PI - circle_area(1.0 - t);
    case WR_PROFILE_SMOOTH: return t * t * t * (1.0 - 0.5 * t);
    case WR_PROFILE_CHAMFER: return 0.5 * t * t;
    case WR_PROFILE_COVE: return t - circle_area(t);
    }
    return 0.0;
}

/* The integral of the height from far outside to d. */
static double area(const WrEdge *edge, double d)
{
    if (d <= 0.0) return 0.0;
    if (d >= edge->bevel) return edge->bevel * profile_area(edge->profile, 1.0) + d - edge->bevel;
    return edge->bevel * profile_area(edge->profile, d / edge->bevel);
}

/* Profile h(d) of the distance d inside the edge, filtered by a box of one texel: the integral of h from d - 1/2 to d + 1/2,
   as a difference of antiderivatives. Exact for straight edges along an axis, and free of steps for all others. */
double wr_edge_height(const WrEdge *edge, double d)
{
    if (d <= -0.5) return 0.0;
    if (d >= edge->bevel + 0.5) return 1.0;
    return area(edge, d + 0.5) - area(edge, d - 0.5);
}

double wr_inside_box(double dx, double dy, double half_x, double half_y, double corner)
{
    double least = half_x < half_y ? half_x : half_y;
    double r = corner < least ? corner : least > 0.0 ? least : 0.0;
    double qx = fabs(dx) - half_x + r, qy = fabs(dy) - half_y + r;
    /* Signed distance to the border of a rounded box, positive inside: outside of the corner's quadrant the nearer side
       counts, in it the circle about (half_x - r, half_y - r). */
    if (qx <= 0.0 || qy <= 0.0) return r - (qx > qy ? qx : qy);
    return r - sqrt(qx * qx + qy * qy);
}
