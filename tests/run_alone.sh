#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# run_alone.sh COMMAND... : runs a test with its own empty home, configuration, cache and temporary folders, so that
# calibrations, machine.trade.json and FFTW's wisdom of the user do not change its result. They are removed afterwards.
set -u
# In /tmp, because the path of a Unix socket has at most 107 bytes. Open to all, because a test runs as another user.
own=$(mktemp -d /tmp/tacto-test-XXXXXX)
trap 'rm -rf "$own"' EXIT
chmod 755 "$own"
mkdir "$own"/{home,config,cache,tmp}
unset XDG_RUNTIME_DIR XDG_DATA_HOME
HOME=$own/home XDG_CONFIG_HOME=$own/config XDG_CACHE_HOME=$own/cache TMPDIR=$own/tmp "$@"
