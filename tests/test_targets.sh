#!/bin/sh
# SPDX-License-Identifier: MIT
# One image on every target whose tools are here.
exec sh tests/targets/run.sh
