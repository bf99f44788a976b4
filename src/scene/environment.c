#include "scene/environment.h"

#include "base/memory.h"

#include <string.h>

void wr_environment_fini(WrEnvironment *environment)
{
    wr_environment_map_free(environment->light);
    wr_free(environment->path);
    wr_free(environment->channel);
    wr_free(environment->part);
    environment->light = NULL;
    environment->path = environment->channel = environment->part = NULL;
}

void wr_environment_copy(WrEnvironment *to, const WrEnvironment *from)
{
    WrEnvironment copy = *from;
    copy.light = wr_environment_map_share(from->light);
    copy.path = wr_strdup(from->path);
    copy.channel = wr_strdup(from->channel);
    copy.part = wr_strdup(from->part);
    wr_environment_fini(to);
    *to = copy;
}

void wr_environment_set(WrEnvironment *environment, WrEnvironmentMapKind kind,
                        WrEnvironmentMap *light, const char *path, const char *sha256)
{
    WrEnvironment made = { .kind = kind, .light = light, .strength = 1 };
    if (kind != WR_ENVIRONMENT_MAP_OFF && environment->kind != WR_ENVIRONMENT_MAP_OFF)
        made.turn_deg = environment->turn_deg, made.strength = environment->strength;
    made.path = wr_strdup(path);
    if (sha256) memcpy(made.sha256, sha256, 64);
    wr_environment_fini(environment);
    *environment = made;
}
