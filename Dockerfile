# Two stages: the packages are built in the first and installed in the second.
#   docker build -t beamgyro . && docker run --rm -v "$PWD:/data" beamgyro \
#     run /usr/share/beamgyro/scenarios/warm_up.toml -o warm_up.h5
FROM debian:12 AS build
WORKDIR /src
COPY . .
RUN apt-get update \
    && apt-get install -y --no-install-recommends ca-certificates dpkg-dev file git \
    && git config --global --add safe.directory /src \
    && scripts/setup.sh demo
RUN scripts/package.sh

FROM debian:12-slim
COPY --from=build /src/build/packages/*.deb /tmp/packages/
RUN apt-get update \
    && rm -f /tmp/packages/libbeamgyro-dev_*.deb \
    && apt-get install -y --no-install-recommends /tmp/packages/*.deb \
    && rm -rf /tmp/packages /var/lib/apt/lists/*
WORKDIR /data
ENTRYPOINT ["beamgyro"]
