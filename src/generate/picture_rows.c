#include "generate/generator.h"

const WrGenerator wr_picture_rows[] = {
    { .family = NULL },
};
