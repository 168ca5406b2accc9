#include "builder/parameters.h"
