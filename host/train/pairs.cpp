#include "host/train/pairs.hpp"
