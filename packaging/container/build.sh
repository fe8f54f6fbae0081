#!/bin/bash
# build.sh SOURCE PREFIX: the command with Lensfun's data, and setup.sh, which prepares the system that runs it.
set -eu -o pipefail
source=$1 prefix=$2
export DEBIAN_FRONTEND=noninteractive
for list in packages.txt packages-profiles.txt; do
    "$source/cmake/install-packages.sh" "$source/$list"
done
cmake -S "$source" -B /tmp/build -DCMAKE_BUILD_TYPE=Release -DCMAKE_INSTALL_PREFIX="$prefix" -DCMAKE_INSTALL_LIBDIR=lib \
    -DLENSPROF_TESTS=OFF >/dev/null
cmake --build /tmp/build --parallel "$(nproc)" >/dev/null
/tmp/build/lensprof profile import --db /tmp/build/lensfun.db /usr/share/lensfun/version_1/*.xml >/dev/null
cp "$source/profiles/lensfun-LICENSE.txt" /tmp/build/lensfun.db.LICENSE.txt
cmake --install /tmp/build >/dev/null
cp "$source/LICENSE" "$source/NOTICE" "$prefix"
# The packages whose libraries the program and its libraries load.
needed=$(ldd "$prefix"/bin/lensprof "$prefix"/lib/*.so | awk '/=> \// {print $3}' | sort -u | xargs -n1 realpath |
    xargs dpkg-query -S 2>/dev/null | cut -d: -f1 | sort -u | xargs)
cat >"$prefix/setup.sh" <<SETUP
#!/bin/sh
set -eu
export DEBIAN_FRONTEND=noninteractive
apt-get -qq update
apt-get -qq install -y --no-install-recommends $needed fonts-dejavu-core >/dev/null
rm -rf /var/lib/apt/lists/*
useradd --create-home --home-dir /work lensprof
SETUP
chmod +x "$prefix/setup.sh"
