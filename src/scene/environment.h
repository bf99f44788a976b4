/* environment.h - the surroundings of a scene: their source, rotation and strength.

   Shared by all objects. */
#pragma once
#include "shade/environment_map.h"

#include <stdbool.h>

typedef struct WrScene WrScene;

typedef struct WrEnvironment {
    WrEnvironmentMapKind kind;
    WrEnvironmentMap *light; /* owned share; NULL if the kind is off */
    char *path;              /* for a file: path from the command; owned */
    char *channel, *part;    /* requested channel and part of the file; owned */
    char sha256[65];
    double turn_deg; /* about the world's y axis, like the turntable */
    double strength; /* 0..1e6: factor of the picture's values */
} WrEnvironment;

/* Sets other surroundings, or none; owns `light`. Turn and strength are kept, but reset for none. path,
   sha256: of a file, or NULL. */
void wr_environment_set(WrEnvironment *environment, WrEnvironmentMapKind kind,
                        WrEnvironmentMap *light, const char *path, const char *sha256);
