#!/bin/sh
# SPDX-License-Identifier: MIT
# The demos of the boards draw what the whole core draws, and fit.
exec sh platform/demo/check.sh
