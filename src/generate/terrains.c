#include "generate/generator.h"

const WrGenerator wr_terrains[] = {
    { .family = NULL },
};
