#include "generate/generator.h"

const WrGenerator wr_solids[] = {
    { .family = NULL },
};
