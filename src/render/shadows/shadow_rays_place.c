/* Selection of possible casters: which objects can hide lamps from which, by bounding spheres and lamp
   positions. */
#include "base/exactmath.h"
#include "render/shadows/shadow_rays.h"

#include <math.h>

#define SLACK (1 + 1e-9)

/* An object with its placement. */
typedef struct Standing {
    WrPlacement place;
    double ball; /* radius of the bounding sphere, world; INFINITY: unbounded */
} Standing;

static double widest(const WrPlacement *place)
{
    const WrVec3 s = place->stretch;
    return place->stretched ? fmax(fabs(s.x), fmax(fabs(s.y), fabs(s.z))) : 1;
}

static bool stand(const WrShadowRaysRequest *ask, int i, Standing *out, WrError *err)
{
    const WrScene *scene = ask->scenes[i];
    WrShadowRaysBody *body = ask->bodies[i];
    wr_shadow_rays_body_size(body, scene, ask->fields[i], ask->moves);
    if (!wr_scene_place_sized(scene, body->radius, ask->turn_deg, ask->aspect, &out->place, err))
        return false;
    out->ball = wr_shape_endless(&scene->shape)
                    ? INFINITY
                    : (body->radius + body->rise) * out->place.size * widest(&out->place) * SLACK;
    return true;
}

/* Distance between a fixed sphere and a sphere that moves from the object to the lamp. It shrinks to a point at
   a point lamp, or keeps its size towards a distant one. Below 0: they touch. t: position along the way, 0..1. */
static double gap(WrVec3 from, WrVec3 way, double ball, bool shrinks, WrVec3 to, double t)
{
    return v3_len(v3_sub(v3_mad(from, way, t), to)) - (shrinks ? ball * (1 - t) : ball);
}

/* True if b can be between any point of a and the lamp. The gap is convex in t, so its minimum is found by
   ternary search. */
static bool may_hide(const Standing *a, const Standing *b, const WrLight *light)
{
    const double spread = tan(fmin(light->size_deg, 45) * WR_PI / 180);
    const bool point = light->kind == WR_LIGHT_POINT;
    const WrVec3 from = a->place.position, to = b->place.position, ahead = { 0, 0, 1 };
    if (!(a->ball < INFINITY) || !(b->ball < INFINITY)) return true;
    const double far = v3_len(v3_sub(to, from)) + a->ball + b->ball;
    const WrVec3 way =
        point ? v3_sub(light->where, from) : v3_scale(v3_unit(light->where, ahead), far);
    double low = 0, high = 1;
    for (int i = 0; i < 100; i++) {
        const double x = low + (high - low) / 3, y = high - (high - low) / 3;
        if (gap(from, way, a->ball, point, to, x) < gap(from, way, a->ball, point, to, y)) high = y;
        else low = x;
    }
    const double wide = spread * (point ? v3_len(way) + a->ball : far);
    return gap(from, way, a->ball, point, to, (low + high) / 2) <= (b->ball + wide) * SLACK;
}

static bool may_any(const WrShadowRaysRequest *ask, const Standing *a, const Standing *b)
{
    const WrScene *scene = ask->scenes[ask->at];
    for (int i = 0; i < scene->light_count; i++)
        if (scene->lights[i].shadow && may_hide(a, b, &scene->lights[i])) return true;
    return false;
}

/* Rotation from a's axes to b's, times `by`, with b's stretch removed. */
static void turn_to(const WrPlacement *a, const WrPlacement *b, double by, double m[9])
{
    const double stretch[3] = { b->stretched ? b->stretch.x : 1, b->stretched ? b->stretch.y : 1,
                                b->stretched ? b->stretch.z : 1 };
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++) {
            double sum = 0;
            for (int j = 0; j < 3; j++) sum += b->rotation[3 * j + i] * a->rotation[3 * j + k];
            m[3 * i + k] = by * sum / stretch[i];
        }
}

static WrShadowRaysTo see(const Standing *a, const Standing *b, const WrShadowRaysBody *body,
                          bool own)
{
    WrShadowRaysTo to = { .body = body, .own = own, .radius = b->ball / a->place.size * SLACK };
    const WrPlacement *pa = &a->place, *pb = &b->place;
    const WrVec3 stretch = pa->stretched ? pa->stretch : (WrVec3){ 1, 1, 1 };
    const WrVec3 centre = v3_times(pa->centre, stretch);
    turn_to(pa, pb, pa->size / pb->size, to.m);
    const WrVec3 at = wr_place_object(pb, pa->position);
    const double *m = to.m;
    to.from = (WrVec3){ at.x - (m[0] * centre.x + m[1] * centre.y + m[2] * centre.z),
                        at.y - (m[3] * centre.x + m[4] * centre.y + m[5] * centre.z),
                        at.z - (m[6] * centre.x + m[7] * centre.y + m[8] * centre.z) };
    const WrVec3 off = wr_place_turn_back(pa, v3_sub(pb->position, pa->position));
    to.middle = v3_mad(centre, off, 1 / pa->size);
    return to;
}

static bool finite_to(const WrShadowRaysTo *to)
{
    double sum = to->from.x + to->from.y + to->from.z;
    for (int k = 0; k < 9; k++) sum += to->m[k];
    return isfinite(sum);
}

static void fill_disc(WrShadowRays *cast, int rays)
{
    cast->rays = rays < WR_SHADOW_RAYS_RAYS ? rays : WR_SHADOW_RAYS_RAYS;
    for (int k = 0; k < cast->rays; k++) { /* evenly distributed, by the golden angle */
        const double r = sqrt((k + 0.5) / cast->rays);
        double sine, cosine;
        wr_sincos_turns(0.38196601125010515 * k, &sine, &cosine);
        cast->disc[k][0] = r * cosine, cast->disc[k][1] = r * sine;
    }
}

bool wr_shadow_rays_prepare(WrShadowRays *cast, const WrShadowRaysRequest *ask, WrError *err)
{
    Standing own, other;
    const int count = ask->count < WR_OBJECTS_MAX ? ask->count : WR_OBJECTS_MAX;
    cast->count = cast->all = 0;
    fill_disc(cast, ask->rays);
    if (!stand(ask, ask->at, &own, err)) return false;
    /* first those that can, then the others */
    for (int round = 0; round < (ask->all ? 2 : 1); round++)
        for (int i = 0; i < count; i++) {
            if (!stand(ask, i, &other, err)) return false;
            const bool self = i == ask->at;
            const bool can =
                self ? !wr_shadow_rays_spares_itself(ask->bodies[i]) : may_any(ask, &own, &other);
            const WrShadowRaysTo to = see(&own, &other, ask->bodies[i], self);
            if (can != (round == 0) || !finite_to(&to)) continue;
            if (!wr_shadow_rays_body_update(ask->bodies[i], ask->scenes[i], ask->fields[i], err))
                return false;
            cast->to[cast->all++] = to;
            cast->count += can;
        }
    const WrShadowRaysBody *body = ask->bodies[ask->at];
    cast->lift = fmax(body->lift, 0x1p-19 * body->radius) * widest(&own.place);
    return true;
}
