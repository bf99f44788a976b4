/* environment.h - the surroundings of a scene: which, how they are turned, and how strong their light is.
   All objects have them in common. */
#pragma once
#include "shade/environment_map.h"

#include <stdbool.h>

typedef struct WrScene WrScene;

typedef struct WrEnvironment {
    WrEnvironmentMapKind kind;
    WrEnvironmentMap *light; /* owned share; NULL where the kind is off */
    char *path;              /* of a file: as the command named it; owned */
    char *channel, *part;    /* of it that were asked for, likewise */
    char sha256[65];
    double turn_deg; /* about the world's y axis, as the turntable turns */
    double strength; /* 0..1e6: times what the picture holds */
} WrEnvironment;

void wr_environment_copy(WrEnvironment *to, const WrEnvironment *from); /* over what `to` has */
/* Other surroundings, whose light is taken over, or none; turn and strength stay, but with none. path, sha256: of a file's,
   or NULL. */
void wr_environment_set(WrEnvironment *environment, WrEnvironmentMapKind kind,
                        WrEnvironmentMap *light, const char *path, const char *sha256);
void wr_environment_fini(WrEnvironment *environment);
